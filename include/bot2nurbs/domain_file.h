// SPDX-License-Identifier: MIT
#pragma once

#include "bot2nurbs/quad_domain.h"

#include <string>
#include <vector>

namespace bot2nurbs {

//! Domain files: JSON, "bot2nurbs.domain/1" (docs/schema/domain.schema.json,
//! docs/algorithms/domain.md), one component for each connected component of the source.
//!
//! 1. Everything of a QuadDomain is in the file or follows from it and the source mesh: what is
//!    read back equals what was written, every double to the bit, and is written as the same bytes.
//! 2. Positions are not stored: a carrier vertex lies where its place on the source is.
//! 3. A component carries the signature of its source mesh and is not read for another.

//! A file of one component.
std::string domain_to_json(const QuadDomain& domain);
//! A file of several components, in this order.
std::string domains_to_json(const std::vector<QuadDomain>& domains);

//! Reads the component that was made for `source`. The result has valid indices and a manifold
//! complex; all else is for validate_domain(). Errors: cannot_read (not JSON, another kind of file
//! or version), stale_domain (no component was made for this mesh; says both signatures),
//! invalid_domain naming the element by its JSON pointer.
Result<QuadDomain> domain_from_json(const std::string& text, const ManifoldMesh& source);
//! Reads one domain for each source, in the order of `sources`. Errors as domain_from_json, and
//! stale_domain too when a component was made for none of them.
Result<std::vector<QuadDomain>> domains_from_json(const std::string& text,
                                                  const std::vector<ManifoldMesh>& sources);

} // namespace bot2nurbs
