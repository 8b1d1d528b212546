# SPDX-License-Identifier: MIT
"""A small JSON Schema validator: the keywords that the schemas of docs/schema use, no others."""

import re

KEYWORDS = {
    "$schema", "$id", "$defs", "$ref", "title", "description", "type", "const", "enum", "required",
    "properties", "additionalProperties", "items", "prefixItems", "minItems", "maxItems", "minimum", "maximum",
    "pattern", "oneOf", "propertyNames", "exclusiveMinimum", "exclusiveMaximum",
}

TYPES = {
    "object": lambda v: isinstance(v, dict),
    "array": lambda v: isinstance(v, list),
    "string": lambda v: isinstance(v, str),
    "number": lambda v: isinstance(v, (int, float)) and not isinstance(v, bool),
    "integer": lambda v: isinstance(v, int) and not isinstance(v, bool),
    "boolean": lambda v: isinstance(v, bool),
    "null": lambda v: v is None,
}


def errors(value, schema, root=None, where="$"):
    """What is wrong with a value, as 'place: what'; empty where it follows the schema."""
    root = schema if root is None else root
    unknown = set(schema) - KEYWORDS
    assert not unknown, f"keywords this validator does not know: {unknown}"
    found = []
    if "$ref" in schema:
        target = root
        for part in schema["$ref"].lstrip("#/").split("/"):
            target = target[part]
        found += errors(value, target, root, where)
    if "type" in schema:
        types = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
        if not any(TYPES[t](value) for t in types):
            return found + [f"{where}: {value!r} is no {' or '.join(types)}"]
    if "const" in schema and value != schema["const"]:
        found.append(f"{where}: {value!r} is not {schema['const']!r}")
    if "enum" in schema and value not in schema["enum"]:
        found.append(f"{where}: {value!r} is none of {schema['enum']}")
    if "oneOf" in schema:
        fits = sum(not errors(value, s, root, where) for s in schema["oneOf"])
        if fits != 1:
            found.append(f"{where}: fits {fits} of the alternatives, not one")
    if isinstance(value, dict):
        for name in schema.get("required", []):
            if name not in value:
                found.append(f"{where}: has no {name}")
        properties = schema.get("properties", {})
        for name, part in value.items():
            rest = schema.get("additionalProperties", {})
            if name in properties:
                found += errors(part, properties[name], root, f"{where}.{name}")
            elif rest is False:
                found.append(f"{where}: {name} is not allowed")
            elif isinstance(rest, dict):
                found += errors(part, rest, root, f"{where}.{name}")
    if isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
            found.append(f"{where}: has {len(value)} items")
        first = schema.get("prefixItems", [])
        for i, (part, rules) in enumerate(zip(value, first)):
            found += errors(part, rules, root, f"{where}[{i}]")
        if "items" in schema:
            for i, part in enumerate(value[len(first):], len(first)):
                found += errors(part, schema["items"], root, f"{where}[{i}]")
    if TYPES["number"](value):
        if "minimum" in schema and value < schema["minimum"]:
            found.append(f"{where}: {value} is less than {schema['minimum']}")
        if "maximum" in schema and value > schema["maximum"]:
            found.append(f"{where}: {value} is more than {schema['maximum']}")
    if isinstance(value, str) and "pattern" in schema and not re.search(schema["pattern"], value):
        found.append(f"{where}: {value!r} does not match {schema['pattern']}")
    return found
