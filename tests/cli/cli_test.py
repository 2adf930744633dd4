#!/usr/bin/env python3
"""The command `lod` as its users run it: help, exit codes, JSON, atomic output, interruption, determinism.

    cli_test.py PART --lod LOD        PART: a name of one of the functions below that end in _part
"""
import argparse
import hashlib
import json
import os
import pty
import re
import resource
import select
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

VERBS = ["build", "simplify", "measure", "info", "convert", "sample"]


class Cli:
    def __init__(self, lod):
        self.lod = lod
        self.dir = Path(tempfile.mkdtemp(prefix="lodestone-cli-"))
        self.failed = 0

    def run(self, *args, cwd=None, limit=120, **more):
        return subprocess.run([self.lod, *map(str, args)], capture_output=True, text=True, timeout=limit,
                              cwd=cwd or self.dir, **more)

    def check(self, good, what):
        if not good:
            self.failed += 1
            print(f"FAILED: {what}")

    def expect(self, run, code, what):
        self.check(run.returncode == code, f"{what}: exit {run.returncode}, expected {code}: {run.stderr.strip()[-300:]}")
        return run

    def sample(self, kind="statue", triangles=5000, name=None):
        path = self.dir / (name or f"{kind}.ply")
        self.expect(self.run("sample", kind, "-o", path, "--triangles", triangles), 0, f"sample {kind}")
        return path

    def leftovers(self):
        return sorted(p.name for p in self.dir.rglob("*") if p.name.endswith(".tmp") or p.name.startswith("."))


def examples(text):
    """The command lines of a help's examples."""
    block = text.split("Examples:", 1)[1].split("\n\n", 1)[0]
    return [line.strip() for line in block.splitlines() if line.strip().startswith("lod ")]


def help_part(t):
    top = t.expect(t.run("help"), 0, "help").stdout
    for verb in VERBS:
        t.check(re.search(rf"^\s+{verb}\b", top, re.M), f"help lists {verb}")
        text = t.expect(t.run("help", verb), 0, f"help {verb}").stdout
        t.check(t.run(verb, "--help").stdout == text, f"lod {verb} --help is lod help {verb}")
        lines = examples(text)
        t.check(len(lines) >= 3, f"{verb} has three examples")
        run_examples(t, verb, lines)
    t.expect(t.run("--version"), 0, "--version")


def run_examples(t, verb, lines):
    """Each example on files of the names that it uses."""
    folder = t.dir / verb
    folder.mkdir()
    for name, kind in (("statue.ply", "statue"), ("terrain.ply", "terrain"), ("tower.glb", "tower"), ("scan.obj", "statue"),
                       ("dragon.ply", "statue"), ("bunny.ply", "statue"), ("a.ply", "statue"), ("model.glb", "tower"),
                       ("part.stl", "statue"), ("house.obj", "terrain"), ("statue.glb", "statue"), ("tower.ply", "tower"), ("models/a.ply", "statue"),
                       ("models/b.obj", "terrain")):
        (folder / name).parent.mkdir(exist_ok=True)
        t.expect(t.run("sample", kind, "-o", folder / name, "--triangles", 3000), 0, f"sample for {name}")
    t.run("simplify", folder / "a.ply", "-o", folder / "b.ply", "--ratio", "0.3")
    t.run("simplify", folder / "statue.ply", "-o", folder / "statue_small.ply", "--ratio", "0.3")
    t.run("simplify", folder / "statue.ply", "-o", folder / "small.ply", "--ratio", "0.3")
    for line in lines:
        words = shlex.split(line.split(" | ")[0])
        run = t.run(*words[1:], cwd=folder)
        t.check(run.returncode in (0, 3), f"example '{line}': exit {run.returncode}: {run.stderr.strip()[-200:]}")


def errors_part(t):
    statue = t.sample()
    cases = [
        (["simplfy", statue], 2, "simplify"),
        (["build", "--levles", "3", statue], 2, "--levels"),
        (["build", statue], 2, "output"),
        (["build", statue, "-o", statue], 2, ""),
        (["build", "missing.ply", "-o", "x.glb"], 1, "missing.ply"),
        (["build", statue, "-o", "no/such/folder/x.glb"], 1, "folder"),
        (["build", statue, "-o", "x.xyz"], 2, "x.xyz"),
        (["build", statue, "-o", "x.glb", "--ratio", "2"], 2, ""),
        (["build", statue, "-o", "x.glb", "--error", "2mm"], 2, "unit"),
        (["build", statue, "-o", "x.glb", "--error", "-1"], 2, ""),
        (["simplify", statue, "-o", "x.ply"], 2, ""),
        (["info", t.dir], 2, "directory"),
    ]
    for args, code, word in cases:
        run = t.expect(t.run(*args), code, f"lod {' '.join(map(str, args))}")
        lines = run.stderr.strip().splitlines()
        t.check(len(lines) == 1 and lines[0].startswith("lod: "), f"{args}: one line, not {lines}")
        t.check(word in run.stderr, f"{args}: '{word}' in {run.stderr!r}")
        t.check(run.stdout == "", f"{args}: nothing on standard output")
    t.check(not (t.dir / "x.glb").exists() and not t.leftovers(), "nothing is left")
    missed = t.expect(t.run("simplify", statue, "-o", "x.ply", "--triangles", "1"), 3, "a target out of reach")
    t.check("fewest" in missed.stderr and (t.dir / "x.ply").exists(), "the result is written and the reason told")


BUILD_KEYS = {"level", "triangles", "error", "relative_error", "error_kind", "switch_distance", "bytes", "file", "seconds"}


def json_part(t):
    statue = t.sample()
    run = t.expect(t.run("build", statue, "-o", "s.glb", "--json"), 0, "build --json")
    j = json.loads(run.stdout)
    t.check({"path", "triangles", "diagonal"} <= j["input"].keys(), "input's fields")
    t.check({"read", "levels", "measure", "write", "total"} <= j["seconds"].keys(), "seconds' fields")
    t.check(j["peak_memory_bytes"] > 0, "peak_memory_bytes")
    t.check([level["level"] for level in j["levels"]] == [0, 1, 2, 3, 4], "five levels")
    for level in j["levels"]:
        t.check(BUILD_KEYS <= level.keys(), f"level's fields {sorted(BUILD_KEYS - level.keys())}")
    t.check(sum(level["bytes"] for level in j["levels"]) == (t.dir / "s.glb").stat().st_size, "bytes add up to the file")
    j = json.loads(t.run("simplify", statue, "-o", "s.ply", "--ratio", "0.1", "--json").stdout)
    keys = {"triangles_in", "triangles", "error", "relative_error", "error_kind", "stop_reason", "seconds", "peak_memory_bytes"}
    t.check(keys <= j.keys(), f"simplify's fields {keys - j.keys()}")
    t.check({"read", "simplify", "measure", "write"} <= j["seconds"].keys(), "simplify's seconds")
    j = json.loads(t.run("measure", statue, "s.ply", "--samples", "20000", "--seed", "4", "--json").stdout)
    keys = {"samples", "max", "mean", "rms", "relative_max", "relative_mean", "relative_rms", "forward", "backward",
            "normal_degrees", "seconds"}
    t.check(keys <= j.keys() and j["samples"] == 20000, f"measure's fields {keys - j.keys()}")
    for side in ("forward", "backward"):
        t.check({"max", "mean", "rms"} <= j[side].keys(), f"{side}'s fields")
    j = json.loads(t.run("info", statue, "--json").stdout)
    keys = {"vertices", "wedges", "triangles", "components", "boundary_edges", "nonmanifold_edges", "duplicate_faces",
            "degenerate_triangles", "closed", "diagonal", "area", "volume", "bounds", "attributes", "materials"}
    t.check(keys <= j.keys(), f"info's fields {keys - j.keys()}")
    t.check(j["closed"] and j["components"] == 1 and j["triangles"] == 5000, "the statue is one closed piece of 5000")


def output_part(t):
    statue = t.sample()
    (t.dir / "old.glb").write_text("old")
    t.expect(t.run("build", "missing.ply", "-o", "old.glb"), 1, "missing input")
    t.check((t.dir / "old.glb").read_text() == "old", "an existing file is unharmed")

    def small_files():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

    full = t.run("build", statue, "-o", "old.glb", preexec_fn=small_files)
    t.expect(full, 1, "no room for the output")
    t.check((t.dir / "old.glb").read_text() == "old" and not t.leftovers(), "a failed write leaves nothing")
    t.expect(t.run("build", statue, "-o", "m_LOD{level}.ply", preexec_fn=small_files), 1, "no room for a file a level")
    t.check(not list(t.dir.glob("m_LOD*")) and not t.leftovers(), "none of the levels appears")
    run = t.expect(t.run("build", statue, "-o", "m_LOD{level}.obj"), 0, "a file a level")
    t.check(len(list(t.dir.glob("m_LOD*.obj"))) == 5, "five files")
    t.check(run.stdout and "level" in run.stdout, "the table is on standard output")
    t.check("\x1b" not in run.stdout + run.stderr, "no colours in a pipe")


def batch_part(t):
    folder = t.dir / "in"
    folder.mkdir()
    for i in range(2):
        t.run("sample", "statue", "-o", folder / f"s{i}.ply", "--triangles", 2000, "--seed", i)
    (folder / "bad.ply").write_text("ply\nnonsense\n")
    run = t.expect(t.run("build", folder, "-o", "out/", "--json"), 1, "a batch with a bad file")
    j = json.loads(run.stdout)
    t.check(len(j["runs"]) == 3, f"three runs, not {len(j['runs'])}")
    t.check((t.dir / "out/s0.glb").exists() and (t.dir / "out/s1.glb").exists(), "the good ones are written")
    t.check("bad.ply" in run.stderr, "the bad one is named")
    empty = t.dir / "empty"
    empty.mkdir()
    t.check(t.run("build", empty, "-o", "out2/").returncode in (1, 2), "an empty folder is an error")


def interrupt_part(t):
    big = t.sample("statue", 600000, "big.ply")
    for wait in (0.05, 0.3, 0.8):
        out = t.dir / "big.glb"
        process = subprocess.Popen([t.lod, "build", str(big), "-o", str(out)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        finished = process.returncode == 0 and out.exists()
        t.check(process.returncode == 130 or finished, f"interrupted after {wait} s: exit {process.returncode}")
        t.check(finished or not out.exists(), "no half output")
        t.check(not t.leftovers(), f"leftovers {t.leftovers()}")
        out.unlink(missing_ok=True)


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def determinism_part(t):
    for kind in ("statue", "tower", "terrain"):
        model = t.sample(kind, 20000, f"{kind}.glb")
        sums = set()
        for threads in (1, 2, 7, 2):
            out = t.dir / "o.glb"
            t.check(t.run("build", model, "-o", out, "--threads", threads).returncode in (0, 3), f"{kind} with {threads}")
            sums.add(digest(out))
        t.check(len(sums) == 1, f"{kind}: the same bytes with 1, 2, 7 threads and again")


def progress_part(t):
    big = t.sample("statue", 300000, "big.ply")
    quiet = t.run("build", big, "-o", "o.glb")
    t.check("%" not in quiet.stderr, "no progress in a pipe")
    shown = on_terminal([t.lod, "build", str(big), "-o", str(t.dir / "o.glb")])
    t.check("%" in shown, "progress on a terminal")
    silent = on_terminal([t.lod, "build", str(big), "-o", str(t.dir / "o.glb"), "--quiet"])
    t.check(silent.strip() == "", f"--quiet is silent, not {silent[:100]!r}")


def on_terminal(command):
    """What a command writes to standard error when that is a terminal."""
    master, slave = pty.openpty()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=slave, stdin=subprocess.DEVNULL)
    os.close(slave)
    text = b""
    while True:
        ready, _, _ = select.select([master], [], [], 60)
        if not ready:
            break
        try:
            chunk = os.read(master, 65536)
        except OSError:
            break
        if not chunk:
            break
        text += chunk
    process.wait(timeout=60)
    os.close(master)
    return text.decode(errors="replace")


def names_part(t):
    for name in ("with space.ply", "żółw-龍.ply", "plus+and%20.ply"):
        path = t.sample("statue", 1000, name)
        t.expect(t.run("build", path, "-o", f"{name}.glb"), 0, f"a file named {name}")
    strange = t.run("info", "a\nb\x1b[31m.ply")
    t.check(strange.returncode == 1 and "\x1b" not in strange.stderr and strange.stderr.count("\n") == 1,
            "control characters of a name are not printed")


def documents_part(t):
    for shell in ("bash", "zsh", "fish"):
        script = t.expect(t.run("completion", shell), 0, f"completion {shell}").stdout
        t.check("simplify" in script and "levels" in script, f"{shell} completes verbs and options")
        if shell == "bash":
            parsed = subprocess.run(["bash", "-n"], input=script, text=True, capture_output=True)
            t.check(parsed.returncode == 0, f"bash reads its script: {parsed.stderr}")
    page = t.expect(t.run("help", "--man"), 0, "man page").stdout
    t.check(page.lstrip().startswith((".TH", ".\\\"")), "a man page")
    for verb in VERBS:
        t.check(verb in page, f"the man page tells of {verb}")


def targets_part(t):
    statue = t.sample("statue", 20000)
    run = t.expect(t.run("build", statue, "-o", "s_LOD{level}.ply", "--error", "0.1%,0.5%", "--json"), 0, "build --error")
    levels = json.loads(run.stdout)["levels"]
    for level, limit in zip(levels[1:], (0.001, 0.005)):
        t.check(level["relative_error"] <= limit, f"level {level['level']} within {limit}")
        again = json.loads(t.run("measure", statue, f"s_LOD{level['level']}.ply", "--samples", "200000", "--json").stdout)
        t.check(again["relative_max"] <= limit * 1.03, f"measured again: {again['relative_max']} for {limit}")
    near = json.loads(t.run("build", statue, "-o", "p.glb", "--pixels", "1", "--distances", "2,8", "--json").stdout)["levels"]
    for level, distance in zip(near[1:], (2, 8)):
        t.check(level["switch_distance"] <= distance * 1.001, f"good for a pixel from {distance}")
    kept = json.loads(t.run("simplify", statue, "-o", "r.ply", "--ratio", "10%", "--json").stdout)
    t.check(abs(kept["triangles"] - 2000) <= 2, "--ratio is the share kept")


def foreign_part(t):
    """What a library reads for us is read in a child process: its trouble is an ordinary error."""
    cube = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
    (t.dir / "t.dae").write_text(cube)
    j = json.loads(t.expect(t.run("info", "t.dae", "--json"), 0, "a COLLADA file").stdout)
    t.check(j["triangles"] == 4 and j["closed"], "a tetrahedron")
    (t.dir / "bad.fbx").write_bytes(b"Kaydara FBX Binary  \0\x1a\0" + bytes(range(256)) * 8)
    bad = t.expect(t.run("info", "bad.fbx"), 1, "a broken FBX")
    t.check("bad.fbx" in bad.stderr and len(bad.stderr.strip().splitlines()) == 1, f"one line: {bad.stderr!r}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("part")
    parser.add_argument("--lod", required=True)
    args = parser.parse_args()
    t = Cli(str(Path(args.lod).resolve()))
    globals()[args.part + "_part"](t)
    print(f"{args.part}: {t.failed} failures")
    return 1 if t.failed else 0


if __name__ == "__main__":
    sys.exit(main())
