# SPDX-License-Identifier: MIT
"""Runs the command on a mesh file and judges what it did: part of the campaigns of this folder."""

import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from math import ceil
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

MAX_ANGLE_DEG = 1e-8  # Between normals at a join: rounding of doubles gives about 1e-11.
# A coordinate at n diagonals from the origin is rounded to 1.1e-16 n diagonals, which turns a leg of
# a control net of 1/1600 of the diagonal by 1e-11 n degrees, and the normal of a corner whose legs
# are a degree apart by sixty times as much. Bodies thinner than that have shorter legs.
FAR_ANGLE_DEG = 6e-10
LEG = 1 / 1600
# A fit with as many patches as the default gives is far closer; what is worse has gone astray.
MAX_RMS = 0.02  # Of the diagonal.
MEMORY_LIMIT = 6 << 30  # Bytes of address space: a runaway allocation must not stop the machine.
WAITING = 10  # Times the limit of processor time, on the clock.
REFUSALS = {3: "cannot read", 5: "rejected", 6: "stage failed"}


@dataclass
class Run:
    """One run of the command."""

    command: list
    code: int = 0  # Exit code; negative: the signal that ended it.
    hang: bool = False
    seconds: float = 0.0  # Of processor time.
    clock: float = 0.0  # Seconds on the clock.
    report: dict = field(default_factory=dict)
    stderr: str = ""
    left: list = field(default_factory=list)  # Names of the files in the folder of the outputs.

    @property
    def message(self):
        """The error as the command stated it."""
        error = self.report.get("error", {}).get("message", "")
        if error:
            return error
        lines = [l for l in self.stderr.splitlines() if not l.endswith("...") and l.strip()]
        return lines[-1] if lines else ""

    @property
    def warnings(self):
        return [w["code"] for w in self.report.get("warnings", [])]

    @property
    def repairs(self):
        return [r["code"] for r in self.report.get("input", {}).get("repairs", [])]


def find_binary(given):
    """The binary to test: as given, else the newest of the build folders."""
    if given:
        path = Path(given).resolve()
        if not path.is_file():
            sys.exit(f"{given}: no such file")
        return path
    built = [p for p in (ROOT / "build").glob("*/bot2nurbs") if p.is_file()]
    if not built:
        sys.exit("no build/*/bot2nurbs: build the target bot2nurbs_cli, or name one with --binary")
    return max(built, key=lambda p: p.stat().st_mtime)


def _limit(seconds):
    os.nice(10)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (ceil(seconds), ceil(seconds) + 1))


def execute(command, seconds, clock=None):
    """Runs a command whose JSON comes on standard output, for at most `seconds` of processor time.

    Processor time, so that other work on the machine changes no verdict; a command that sleeps is
    stopped after WAITING times as long on the clock, or after `clock` seconds.
    """
    clock = clock or WAITING * seconds
    begin = time.monotonic()
    run = Run([str(c) for c in command])
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        process = subprocess.Popen(
            run.command, stdout=out, stderr=err, preexec_fn=lambda: _limit(seconds)
        )
        end = begin + clock
        pid = 0
        while pid == 0:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid == 0:
                if time.monotonic() > end:
                    os.kill(process.pid, signal.SIGKILL)
                    end += clock
                time.sleep(0.02)
        run.code = process.returncode = os.waitstatus_to_exitcode(status)
        run.seconds = usage.ru_utime + usage.ru_stime
        run.clock = time.monotonic() - begin
        run.hang = run.code in (-signal.SIGXCPU, -signal.SIGKILL)
        out.seek(0)
        err.seek(0)
        text = out.read()
        run.stderr = err.read().decode("utf-8", "replace")
    try:
        run.report = json.loads(text)
    except ValueError:
        run.report = {}
    return run


def convert(binary, mesh, seconds, threads=1, output="result.3dm", keep=None, clock=None):
    """Converts `mesh` in an empty folder; with `keep` the output is moved there."""
    with tempfile.TemporaryDirectory(prefix="bot2nurbs_") as folder:
        target = Path(folder) / output
        command = [binary, mesh, target, "--json", "-", "--threads", str(threads)]
        run = execute(command, seconds, clock)
        run.left = sorted(p.name for p in Path(folder).iterdir())
        if keep and target.exists():
            Path(keep).write_bytes(target.read_bytes())
    return run


def check(binary, mesh, seconds):
    """What the command says of `mesh` without converting it."""
    return execute([binary, mesh, "--check", "--json", "-", "--threads", "1"], seconds)


def allowed_angle(component):
    """Largest angle in degrees between normals at joins that rounding of the result explains."""
    side = component["deviation"]["source_to_surface"]
    diagonal = component["deviation"]["diagonal"]
    place = max(abs(x) for x in side["worst"]) / diagonal
    # No body is thinner everywhere than its volume over the area of its box's largest section.
    thickness = abs(component["brep"]["volume"]) / diagonal**3 if component["brep"]["solid"] else LEG
    shorter = max(1.0, LEG / thickness) if thickness > 0 else 1.0
    return max(MAX_ANGLE_DEG, FAR_ANGLE_DEG * place * shorter)


def faults(run, genera=None, output="result.3dm"):
    """Why a run is no sound result and no proper refusal; empty when it is one of the two.

    `genera`: of the components, where they are known.
    """
    if run.hang:
        return [f"no end after {run.seconds:.0f} s of processor time, {run.clock:.0f} s on the clock"]
    if run.code < 0:
        return [f"ended by signal {signal.Signals(-run.code).name}"]
    found = []
    if run.code != 0:
        if run.code not in REFUSALS:
            found.append(f"exit code {run.code}: {run.message}")
        if not run.message:
            found.append("no message")
        if run.code in REFUSALS and "error" not in run.report:
            found.append("no error in the report")
        if run.left:
            found.append("left behind: " + ", ".join(run.left))
        return found
    report = run.report
    if not report or "error" in report:
        return ["exit code 0 without a report of success"]
    if run.left != [output]:
        found.append("files written: " + (", ".join(run.left) or "none"))
    if not report["components"]:
        found.append("no component")
    for number, c in enumerate(report["components"]):
        brep, joins, far = c["brep"], c["continuity"], c["deviation"]
        where = f"component {number}: " if len(report["components"]) > 1 else ""
        if not brep["valid"]:
            found.append(where + "not valid")
        loops = c["boundary_loops"]
        if brep["solid"] != (loops == 0) or (brep["boundary_edges"] == 0) != (loops == 0):
            found.append(where + ("closed" if loops else "not solid"))
        if brep["nonmanifold_edges"]:
            found.append(where + "not manifold")
        euler = brep["vertices"] - brep["edges"] + brep["faces"]
        if euler != 2 - 2 * c["genus"] - loops:
            found.append(where + f"Euler number {euler} at genus {c['genus']}")
        if genera is not None and c["genus"] != genera[number]:
            found.append(where + f"genus {c['genus']} instead of {genera[number]}")
        if not joins["max_g1_angle_deg"] <= allowed_angle(c):
            found.append(where + f"normals differ by {joins['max_g1_angle_deg']:.2g} degrees")
        if joins["max_gap"] != 0.0 or brep["max_edge_gap"] != 0.0:
            found.append(where + f"gap {max(joins['max_gap'], brep['max_edge_gap']):.2g}")
        if not 0.0 <= far["rms_relative"] <= MAX_RMS:
            found.append(where + f"rms {100 * far['rms_relative']:.2g} % of the diagonal")
    return found


def table(header, rows):
    """A Markdown table as lines."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    for row in rows:
        cells = [str(c).replace("|", "\\|").replace("\n", " ") for c in row]
        lines.append("| " + " | ".join(cells) + " |")
    return lines
