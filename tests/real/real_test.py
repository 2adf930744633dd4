#!/usr/bin/env python3
"""The command on every shared model, judged by tools that share no code with it.

    real_test.py ladders|readback|broken|formats|gltf|three|volumes[/I/N] --lod LOD --meshjudge JUDGE --data DIR --npm DIR

/I/N: of N shares of the models the I-th.

Exit status: 0 all well, 1 with a line for each thing that isn't, 77 when something it needs is missing.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from make_gltf import write_all

HERE = Path(__file__).resolve().parent
LARGE_BYTES = 1_200_000
MODELS = {".ply", ".obj", ".stl", ".off", ".glb", ".gltf"}


class Judge:
    """Runs the commands and collects complaints."""

    def __init__(self, args):
        self.args = args
        self.scratch = Path(tempfile.mkdtemp(prefix="lodestone-real-"))
        self.complaints = []
        self.checked = 0
        self.share, self.shares = 1, 1

    def complain(self, text):
        self.complaints.append(text)

    def lod(self, *args, limit=300):
        return subprocess.run([self.args.lod, *map(str, args)], capture_output=True, text=True, timeout=limit)

    def judge(self, *args):
        run = subprocess.run([self.args.meshjudge, *map(str, args), "--json"], capture_output=True, text=True, timeout=300)
        if run.returncode != 0:
            raise RuntimeError(f"meshjudge {args}: {run.stderr.strip()}")
        return json.loads(run.stdout)

    def models(self, *folders):
        """This share of the models in folders, by turns, so that large and small ones are spread."""
        paths = [path for folder in folders for path in sorted((self.args.data / folder).rglob("*"))
                 if path.suffix.lower() in MODELS and path.is_file()]
        yield from paths[self.share - 1::self.shares]

    def build(self, path, *options):
        """The ladder of a model and its JSON, or None after a complaint."""
        out = self.scratch / "out.glb"
        out.unlink(missing_ok=True)
        run = self.lod("build", path, "-o", out, "--json", *options)
        self.checked += 1
        if run.returncode not in (0, 3):
            self.complain(f"{path.name}: exit {run.returncode}: {run.stderr.strip()[-200:]}")
            return None, None
        if run.returncode == 3 and len(run.stderr.strip()) < 20:
            self.complain(f"{path.name}: exit 3 without a reason")
        return out, json.loads(run.stdout)


def ladders(t):
    """Levels are what the JSON says, their errors are the referee's, closed manifold stays so."""
    for path in t.models("meshes", "textured"):
        # Large ones without shaping, which the others have: it takes most of the time.
        out, report = t.build(path, *(["--effort", "fast"] if path.stat().st_size > LARGE_BYTES else []))
        if out is None:
            continue
        errors = [level["error"] for level in report["levels"]]
        if errors != sorted(errors) or errors[0] != 0:
            t.complain(f"{path.name}: errors fall: {errors}")
        start = t.judge("topology", out, "--level", 0)
        clean = start["closed"] and start["manifold"]
        for level in report["levels"][1:]:
            k = level["level"]
            now = t.judge("topology", out, "--level", k)
            if now["triangles"] != level["triangles"]:
                t.complain(f"{path.name} level {k}: {now['triangles']} triangles, the JSON says {level['triangles']}")
            if clean and not (now["closed"] and now["manifold"] and now["duplicate_faces"] == 0):
                t.complain(f"{path.name} level {k}: no longer closed and manifold")
            if now["duplicate_faces"] > start["duplicate_faces"]:
                t.complain(f"{path.name} level {k}: {now['duplicate_faces']} duplicate faces")
            if now["nonmanifold_edges"] > start["nonmanifold_edges"]:
                t.complain(f"{path.name} level {k}: {now['nonmanifold_edges']} non-manifold edges")
            compare_errors(t, path, out, level)


def compare_errors(t, path, out, level):
    k = level["level"]
    # Polygons are fanned by the referee and cut properly by us: so against level 0 of the written file.
    d = t.judge("distance", out, out, "--level-a", 0, "--level-b", k, "--samples", 100000)
    floor = 1e-7 * d["diagonal"]  # below this, rounding decides
    if abs(level["mean_error"] - d["mean"]) > 0.03 * d["mean"] + floor:  # where few spots make the mean, chance has a say
        d = t.judge("distance", out, out, "--level-a", 0, "--level-b", k, "--samples", 1000000)
    if abs(level["mean_error"] - d["mean"]) > 0.03 * d["mean"] + floor:
        t.complain(f"{path.name} level {k}: mean {level['mean_error']:.6g}, the referee {d['mean']:.6g}")
    if level["error"] < 0.97 * d["max"] - floor:
        t.complain(f"{path.name} level {k}: error {level['error']:.6g}, the referee found {d['max']:.6g}")


def readback(t):
    """Ladders by other ways: what was told is in the file, as the referee reads it."""
    ways = (["--effort", "best"], ["--method", "voxel"], ["--method", "voxel", "--then-collapse"])
    names = ("meshes/bunny_7k.off", "meshes/fandisk.obj", "meshes/teapot.obj", "textured/DamagedHelmet.glb",
             "textured/Duck.glb", "textured/CesiumMan.glb")
    for name in names[t.share - 1::t.shares]:
        for way in ways:
            out, report = t.build(t.args.data / name, "--ratio", "20%,4%", "--verify", *way)
            if report and not report["verified"]["largest_difference"] <= 0.01:
                t.complain(f"{name} {' '.join(way)}: read back, an error differs by {report['verified']['largest_difference']}")
            for level in report["levels"][1:] if report else []:
                d = t.judge("distance", out, out, "--level-a", 0, "--level-b", level["level"], "--samples", 100000)
                floor = 2e-6 * d["diagonal"]
                if not d["max"] - floor <= level["error"] <= 3 * d["max"] + floor:
                    t.complain(f"{name} {' '.join(way)} level {level['level']}: says {level['error']:.6g}, "
                               f"the file measures {d['max']:.6g}")
    for name in ("textured/Fox/Fox.gltf", "meshes/cow.obj"):  # and as we read it back ourselves, in every format
        for output in ("o.gltf", "o{level}.ply", "o{level}.obj", "o{level}.stl"):
            folder = Path(tempfile.mkdtemp(dir=t.scratch))
            run = t.lod("build", t.args.data / name, "-o", folder / output, "--verify", "--ratio", "30%,10%")
            t.checked += 1
            if run.returncode not in (0, 3):
                t.complain(f"{name} to {output}: {run.stderr.strip()[-200:]}")


def broken(t):
    """A result or one clear line; nothing left behind by a failure."""
    for path in t.models("broken"):
        out = t.scratch / "out.glb"
        out.unlink(missing_ok=True)
        run = t.lod("build", path, "-o", out, "--levels", 3, limit=30)
        t.checked += 1
        if run.returncode not in (0, 1, 3):
            t.complain(f"{path.name}: exit {run.returncode}")
        if run.returncode == 1:
            lines = [line for line in run.stderr.splitlines() if line.startswith("lod: ") and not line.startswith("lod: warning")]
            if len(lines) != 1 or path.name not in lines[0]:
                t.complain(f"{path.name}: not one clear line: {run.stderr.strip()[-200:]}")
            if list(t.scratch.iterdir()):
                t.complain(f"{path.name}: left {[p.name for p in t.scratch.iterdir()]}")


def formats(t):
    """Converting keeps counts and shape."""
    for name in ("meshes/cow.obj", "meshes/fandisk.obj", "textured/spot_textured/spot.obj", "textured/Duck.glb"):
        source = t.args.data / name
        want = json.loads(t.lod("info", source, "--json").stdout)
        for extension in (".ply", ".obj", ".stl", ".off", ".glb", ".gltf"):
            folder = t.scratch / f"{source.stem}{extension[1:]}"
            folder.mkdir()
            out = folder / f"x{extension}"
            run = t.lod("convert", source, out)
            t.checked += 1
            if run.returncode != 0:
                t.complain(f"{name} to {extension}: {run.stderr.strip()}")
                continue
            got = json.loads(t.lod("info", out, "--json").stdout)
            for key in ("triangles", "boundary_edges", "components"):
                if got[key] != want[key]:
                    t.complain(f"{name} to {extension}: {key} {got[key]}, was {want[key]}")
            if abs(got["area"] / want["area"] - 1) > 1e-5:
                t.complain(f"{name} to {extension}: area {got['area']}, was {want['area']}")


def node(t, script, *args):
    if not (t.args.npm / "node_modules").exists():
        print(f"{t.args.npm}/node_modules is missing: run tools/npm_install")
        sys.exit(77)
    run = subprocess.run(["node", HERE / script, t.args.npm / "node_modules", *args], capture_output=True, text=True, timeout=120)
    return run.returncode, (run.stdout + run.stderr).strip()


def validate(t, paths):
    """What the Khronos validator says of each file, by path. One process for all."""
    status, text = node(t, "validate_gltf.mjs", *map(str, paths))
    found = [json.loads(line) for line in text.splitlines()] if status == 0 else []
    if len(found) != len(paths):
        raise RuntimeError(f"the validator failed: {text[-300:]}")
    return {Path(one["file"]): one for one in found}


def gltf(t):
    """What is written has never more errors than what was read; none at all but for what cannot be mended, only told."""
    made = t.scratch / "made"
    made.mkdir()
    jobs = [(path, compression) for path in [*t.models("textured"), *write_all(made)[t.share - 1::t.shares]] for compression in ("none", "meshopt", "draco")]
    jobs += [(path, "none") for path in t.models("broken")]
    written = {}
    for path, compression in jobs:
        kept = t.scratch / f"{len(written)}.glb"
        out = t.scratch / "out.glb"
        run = t.lod("build", path, "-o", out, "--levels", 3, "--effort", "fast", "--compress", compression)
        t.checked += 1
        if out.exists():
            out.rename(kept)
            written[kept] = (path, compression)
        elif "broken" not in path.parts:
            t.complain(f"{path.name} {compression}: exit {run.returncode}: {run.stderr.strip()[-200:]}")
    inputs = sorted({path for path, _ in written.values() if path.suffix.lower() in (".glb", ".gltf")})
    said = validate(t, [*inputs, *written])
    for out, (path, compression) in written.items():
        kept = "broken" in path.parts or path.stem == "odd_transforms"
        allowed = (said[path]["errors"] or 0) if kept and path in said else 0
        if said[out]["errors"] is None or said[out]["errors"] > allowed:
            t.complain(f"{path.name} {compression}: {said[out]['errors']} errors, {allowed} allowed: {said[out]['first']}")


def three(t):
    """three.js loads what is written; textures, skins and animations are still there."""
    wanted = {"CesiumMan.glb": "skins 1 animations 1", "Fox.gltf": "skins 1 animations 3"}
    for path in t.models("textured"):
        out, _ = t.build(path, "--levels", 3)
        if out is None:
            continue
        status, text = node(t, "load_three.mjs", out)
        if status != 0 or wanted.get(path.name, "") not in text:
            t.complain(f"{path.name}: {text[:300]}")


REFUSED = {"fixed2d.mhd": "single slice", "dicom_ct_uneven_spacing": "missing", "dicom_mr_two_orientations": "2 series",
           "dicom_mr_two_series": "2 series"}


def volumes(t):
    """Every volume gives a closed surface where its file says, or a refusal that tells why."""
    out = t.scratch / "v.ply"
    boxes = {}

    def surface(name, *options):
        out.unlink(missing_ok=True)
        run = t.lod("convert", t.args.data / "volumes" / name, "-o", out, *options)
        t.checked += 1
        if "not built in" in run.stderr:
            sys.exit(77)
        return run

    for path in sorted((t.args.data / "volumes").iterdir()):
        if path.suffix == ".raw":
            continue
        run = surface(path.name)
        if path.name in REFUSED:
            if run.returncode not in (1, 2) or REFUSED[path.name] not in run.stderr or out.exists():
                t.complain(f"{path.name}: exit {run.returncode}: {run.stderr.strip()[-200:]}")
            continue
        if run.returncode != 0:
            t.complain(f"{path.name}: exit {run.returncode}: {run.stderr.strip()[-200:]}")
            continue
        shape = t.judge("topology", out)
        if not shape["closed"] or shape["nonmanifold_edges"] or shape["duplicate_faces"]:
            t.complain(f"{path.name}: {shape}")
        box = json.loads(t.lod("info", out, "--json").stdout)["bounds"]
        boxes[path.name] = (box["min"], box["max"])
    # The same values by other ways are the same surface.
    for iso in ("40", "120.5"):
        surface("nucleon_stack.tif", "--iso", iso)
        stack = out.read_bytes()
        surface("nucleon_41x41x41_uint8.raw", "--iso", iso, "--raw", "41,41,41")
        if out.read_bytes() != stack:
            t.complain(f"nucleon at {iso}: the TIFF and the bare values differ")
    # First and last voxel of the head's slices by their position tags, half a voxel more where the surface closes.
    low, high = boxes["dicom_pet_head"]
    if not (-331.4 - 1.7 <= low[2] and high[2] <= -253.7 + 1.7):
        t.complain(f"dicom_pet_head lies from {low} to {high}")
    for series, size in (("1", "256"), ("2", "64")):
        run = surface("dicom_mr_two_series", "--series", series)
        if run.returncode != 0:
            t.complain(f"--series {series}: {run.stderr.strip()[-200:]}")
    for options, part in ((("--iso", "99999"), "180"), (("--series", "7"), ""), (("--iso", "x"), "number")):
        run = surface("brain_uchar_8.nii.gz", *options)
        if options[0] == "--iso" and (run.returncode == 0 or part not in run.stderr):
            t.complain(f"{options}: exit {run.returncode}: {run.stderr.strip()[-200:]}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("part")
    for name in ("--lod", "--meshjudge"):
        parser.add_argument(name, required=True)
    for name in ("--data", "--npm"):
        parser.add_argument(name, type=lambda text: Path(text).resolve(), required=True)
    parts = {f.__name__: f for f in (ladders, readback, broken, formats, gltf, three, volumes)}
    t = Judge(parser.parse_args())
    name, *share = t.args.part.split("/")
    if name not in parts:
        parser.error(f"no part '{name}'; there are: {' '.join(parts)}")
    if share:
        t.share, t.shares = map(int, share)
    parts[name](t)
    for complaint in t.complaints:
        print(complaint)
    print(f"{t.args.part}: {t.checked} runs, {len(t.complaints)} complaints")
    return 1 if t.complaints or t.checked == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
