#!/usr/bin/env python3
"""Ends the program at random moments and in random ways, and looks at what is left.

Usage: faults.py PROGRAM SCENES [--runs N] [--seed S] [--leave-out FAULT]

PROGRAM is sightline, SCENES the folder of the sample scenes.  N times a command and a
fault are drawn, over all commands and all of

    kill       SIGKILL at a random moment
    term       SIGTERM at a random moment
    full       no byte beyond a random size goes into any file
    device     standard output, or --json's file, is a device that is full
    read-only  the folder that the outputs go to may not be written to
    closed     standard output is closed
    memory     less address space than the command takes, but enough for --version

Always a file under its final name is whole, what was there before or what the command
writes; only a .vtm and a report of before may be gone.  Where the program could still
tell, its status and its one line on standard error are right, and no temporary file is
left; what a killed one left, the next run removes.
Prints what was done and every violation; its status is 1 if there was one.
"""

import argparse
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
import zipfile
import zlib

PORTALS = {"portals": [[[0, 0, z], [1, 0, z], [1, 2, z], [0, 2, z]] for z in range(6)]}
SEGMENTS = {"segments": [[[i, -3, i * i % 7], [i * i % 5, 4, 3 - i]] for i in range(9)]}
QUESTION = {
    "instances": [
        {
            "a": [[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1]],
            "b": [[4, -1, -1], [4, 1, -1], [4, 1, 1], [4, -1, 1]],
            "occluders": [[[2, -9, -9], [2, 0.3, -9], [2, 0.3, 9], [2, -9, 9]]],
        }
    ]
    * 200
}
CUBE = "".join(f"v {i & 1} {i >> 1 & 1} {i >> 2}\n" for i in range(8)) + (
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
)
SENSORS = "".join(f"{i},{i % 4},{2 * i},0,1,0\n" for i in range(1, 20))
# In a folder that has the inputs; outputs go below out/.
COMMANDS = [
    "info room.obj --json out/a.json --vtk out/vtk",
    "info room.obj",
    "skeleton cornell.obj -o out/s.json --json out/a.json --vtk out/vtk --list",
    "skeleton room.obj --kinds EV --list --json -",
    "skeleton cornell.obj --saved saved.json --seen-from outside --json out/a.json",
    "look room.obj --from 5,1.6,4 --direction 1,2,3 --svg out/v.svg --png out/v.png --pixels 300 "
    "--csv out/v.csv --vtk out/vtk --list --json out/a.json",
    "look cornell.obj --from 1/3,2,7 --svg out/v.svg",
    "stab portals.json --json out/a.json --vtk out/vtk --list",
    "transversals segments.json --json out/a.json --vtk out/vtk --list",
    "visible question.json --json out/a.json",
    "visible room.obj lamp_shade shelf --json out/a.json --vtk out/vtk",
    "shadows cornell.obj --light light --at sensors.txt --structure --csv out/t.csv --json out/a.json",
    "shadows cornell.obj --light light --receivers floor --list --csv out/t.csv --vtk out/vtk "
    "--json out/a.json",
    "shadows cornell.obj --light light --png out/p.png --eye 28,27,-60 --towards 28,27,0 "
    "--up 0,1,0 --size 60x60",
    "formfactors cornell.obj --lines 20000 --csv out/t.csv --npz out/f.npz --json out/a.json",
    "formfactors cornell.obj --at sensors.txt --accuracy 1e-4 --csv out/t.csv",
    "aspects cube.obj --projection perspective --list --json out/a.json",
    "aspects cornell.obj --projection perspective --method sampled --samples 60 --json -",
    "viewpoints cube.obj --projection orthographic --best 2 --json out/a.json",
    "view room.obj --size 500,300 --png out/p.png",
    "view saved.json --size 300,200 --png out/p.png",
    "analyse cornell.obj -o out/report",
    "analyse cornell.obj -o out/report --only look --from 1/3,2,7 --direction 1,2,3",
]
FAULTS = ["kill", "term", "full", "device", "read-only", "closed", "memory"]
ANSWERED, FAILED, BAD_INPUT, PARTIAL = range(4)


def why_not_whole(path):
    """None for a whole file, else what is wrong with it."""
    data = path.read_bytes()
    try:
        if path.suffix == ".json":
            json.loads(data)
        elif path.suffix == ".vtm":
            for block in xml.etree.ElementTree.fromstring(data).iter("DataSet"):
                if not (path.parent / block.get("file")).is_file():
                    return f"lists {block.get('file')}, which is not there"
        elif path.suffix == ".svg":
            xml.etree.ElementTree.fromstring(data)
        elif path.suffix == ".csv":
            rows = data.split(b"\n")
            if rows.pop() != b"" or len({row.count(b",") for row in rows}) != 1:
                return "is cut off"
        elif path.suffix == ".vtp":
            # Raw bytes stand between the head, which is XML, and the end.
            if not b"<VTKFile" in data[:100] or not data.rstrip().endswith(b"</VTKFile>"):
                return "is cut off"
        elif path.suffix == ".png":
            return why_no_png(data)
        elif path.suffix == ".npz":
            with zipfile.ZipFile(path) as file:
                return file.testzip()
        elif path.suffix == ".html":
            if not data.rstrip().endswith(b"</html>"):
                return "is cut off"
        elif path.name == "files.txt":
            if not data.endswith(b"\n"):
                return "is cut off"
        elif path.suffix != ".obj":
            return "is of a kind that nobody checks"
    except (ValueError, zipfile.BadZipFile, xml.etree.ElementTree.ParseError) as error:
        return str(error)
    return None


def why_no_png(data):
    at = 8
    while data[at + 4 : at + 8] != b"IEND":
        size = int.from_bytes(data[at : at + 4], "big")
        if at + size + 12 > len(data):
            return "is cut off"
        sum_there = int.from_bytes(data[at + 8 + size : at + 12 + size], "big")
        if zlib.crc32(data[at + 4 : at + 8 + size]) != sum_there:
            return "has a wrong checksum"
        at += size + 12
    return None if len(data) == at + 12 else "does not end where it says"


class Faults:
    def __init__(self, program, scenes, seed):
        self.program = str(pathlib.Path(program).resolve())
        self.random = random.Random(seed)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="sightline-faults-"))
        os.chmod(self.folder, 0o777)
        self.out = self.folder / "out"
        self.old = self.folder / "old"
        self.violations = []
        self.counts = {}
        for name in ["room.obj", "cornell.obj"]:
            shutil.copy(pathlib.Path(scenes) / name, self.folder)
        (self.folder / "cube.obj").write_text(CUBE)
        (self.folder / "sensors.txt").write_text(SENSORS)
        for name, value in [("portals", PORTALS), ("segments", SEGMENTS), ("question", QUESTION)]:
            (self.folder / f"{name}.json").write_text(json.dumps(value))
        self.expect_answer("skeleton cornell.obj -o saved.json")
        self.learn()

    def command(self, line):
        return [self.program] + line.split()

    def expect_answer(self, line):
        done = self.run(line, stdout=subprocess.PIPE)
        if done.returncode != ANSWERED:
            raise SystemExit(f"without a fault: {line}: {done.returncode}, {done.stderr}")
        return done.stdout

    def run(self, line, **how):
        how = {"stdout": subprocess.DEVNULL, **how}
        return subprocess.run(
            self.command(line),
            cwd=self.folder,
            stderr=subprocess.PIPE,
            stdin=subprocess.DEVNULL,
            text=True,
            timeout=600,
            **how,
        )

    def learn(self):
        """Of each command, without a fault: how long, how much memory, how large a file."""
        self.seconds, self.address_space, self.largest, self.prints = {}, {}, {}, {}
        for line in COMMANDS:
            self.fresh()
            start = time.monotonic()
            self.prints[line] = self.expect_answer(line) != ""
            self.seconds[line] = time.monotonic() - start
            files = [f for f in self.out.rglob("*") if f.is_file()]
            self.largest[line] = max([f.stat().st_size for f in files], default=4096)
            for file in files:
                if why_not_whole(file):
                    raise SystemExit(f"without a fault: {line}: {file.name} {why_not_whole(file)}")
        self.least = self.least_address_space("--version", 1 << 22)

    def least_address_space(self, line, low):
        """The program runs this within so many bytes, to a few per cent."""
        high = 1 << 33
        while high > 1.03 * low:
            middle = int((low * high) ** 0.5)
            if self.run(line, preexec_fn=limit(resource.RLIMIT_AS, middle)).returncode == 0:
                high = middle
            else:
                low = middle
        return high

    def memory_of(self, line):
        if line not in self.address_space:
            self.fresh()
            self.address_space[line] = self.least_address_space(line, self.least)
        return self.address_space[line]

    def fresh(self):
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir()

    def violation(self, what):
        self.violations.append(f"{self.now}: {what}")
        print(f"VIOLATION {self.violations[-1]}", flush=True)

    def check_files(self, before, may_leave):
        for file in sorted(self.out.rglob("*")):
            if not file.is_file():
                continue
            if file.name.startswith(".sightline-"):
                if not may_leave:
                    self.violation(f"left {file.relative_to(self.out)}")
            elif file.read_bytes() != before.get(file) and why_not_whole(file):
                self.violation(f"{file.relative_to(self.out)} {why_not_whole(file)}")
        # A report's files go before new ones are written, and what lists VTK files before
        # one of them is replaced.
        goes = (lambda file: True) if " analyse " in self.now else is_list_of_files
        for file in before:
            if not file.is_file() and not goes(file):
                self.violation(f"{file.relative_to(self.out)} is gone")

    def check_told(self, status, err, expected):
        if status not in expected:
            self.violation(f"status {status}, not among {expected}; {err.strip()!r}")
        lines = [l for l in err.split("\n") if l]
        if status in (FAILED, BAD_INPUT) and (
            len(lines) != 1 or not lines[0].startswith("sightline: ")
        ):
            self.violation(f"not one line: {err!r}")
        if "internal error" in err:
            self.violation(f"not our own failure: {err.strip()!r}")

    def once(self, line, fault):
        self.now = f"{fault}: sightline {line}"
        self.fresh()
        if self.random.random() < 0.5:  # outputs of an earlier run are there
            self.expect_answer(line)
        before = {f: f.read_bytes() for f in self.out.rglob("*") if f.is_file()}
        status, err, expected = getattr(self, fault.replace("-", "_"))(line)
        self.counts[fault, status] = self.counts.get((fault, status), 0) + 1
        self.check_told(status, err, expected)
        self.check_files(before, may_leave=status < 0)
        if status < 0:  # the next run ends well and clears up
            self.expect_answer(line)
            self.check_files(before, may_leave=False)

    # ---- faults: status, standard error, the statuses that are right

    def signalled(self, line, number):
        child = subprocess.Popen(
            self.command(line),
            cwd=self.folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            stdin=subprocess.DEVNULL,
            text=True,
        )
        time.sleep(self.random.uniform(0, 1.1 * self.seconds[line]))
        child.send_signal(number)
        _, err = child.communicate(timeout=600)
        return child.returncode, err

    def kill(self, line):
        return *self.signalled(line, signal.SIGKILL), {-signal.SIGKILL, ANSWERED}

    def term(self, line):
        return *self.signalled(line, signal.SIGTERM), {-signal.SIGTERM, ANSWERED, PARTIAL}

    def full(self, line):
        size = int(self.largest[line] * self.random.random() ** 2)
        done = self.run(line, preexec_fn=limit(resource.RLIMIT_FSIZE, size))
        return done.returncode, done.stderr, {FAILED, ANSWERED}

    def device(self, line):
        if "out/a.json" in line and self.random.random() < 0.5:
            done = self.run(line.replace("out/a.json", "/dev/full"))
            return done.returncode, done.stderr, {FAILED}
        with open("/dev/full", "w") as full:
            done = self.run(line, stdout=full)
        return done.returncode, done.stderr, {FAILED if self.prints[line] else ANSWERED}

    def closed(self, line):
        done = self.run(line, stdout=None, preexec_fn=lambda: os.close(1))
        return done.returncode, done.stderr, {FAILED if self.prints[line] else ANSWERED}

    def read_only(self, line):
        for folder in [self.out] + [f for f in self.out.rglob("*") if f.is_dir()]:
            os.chmod(folder, 0o555)
        done = self.run(line, preexec_fn=be_nobody)
        for folder in [self.out] + [f for f in self.out.rglob("*") if f.is_dir()]:
            os.chmod(folder, 0o755)
        writes = "out/" in line
        return done.returncode, done.stderr, {BAD_INPUT if writes else ANSWERED}

    def memory(self, line):
        need = max(self.memory_of(line), self.least)
        size = int(self.random.uniform(self.least, need))
        done = self.run(line, preexec_fn=limit(resource.RLIMIT_AS, size))
        return done.returncode, done.stderr, {FAILED, ANSWERED}


def is_list_of_files(path):
    return path.suffix == ".vtm"


def limit(what, size):
    def set_it():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(what, (size, size))

    return set_it


def be_nobody():
    """The superuser may write anywhere."""
    if os.geteuid() == 0:
        os.setgid(65534)
        os.setuid(65534)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("program")
    parser.add_argument("scenes")
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--leave-out", choices=FAULTS, action="append", default=[])
    asked = parser.parse_args()
    faults = Faults(asked.program, asked.scenes, asked.seed)
    try:
        kinds = [fault for fault in FAULTS if fault not in asked.leave_out]
        plan = [(line, fault) for fault in kinds for line in COMMANDS]
        faults.random.shuffle(plan)
        for i in range(asked.runs):
            faults.once(*plan[i % len(plan)])
    finally:
        shutil.rmtree(faults.folder, ignore_errors=True)
    for (fault, status), count in sorted(faults.counts.items()):
        print(f"{fault:10} status {status:4}: {count}")
    print(f"{asked.runs} runs, seed {asked.seed}: {len(faults.violations)} violations")
    return 1 if faults.violations else 0


if __name__ == "__main__":
    sys.exit(main())
