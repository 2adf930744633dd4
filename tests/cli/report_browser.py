#!/usr/bin/env python3
"""Opens the report of a sample in headless Chromium (report_browser.mjs).

    report_browser.py --lod LOD --npm FOLDER [--update]

Exit status: 0 all well, 1 with a line for each thing that isn't, 77 when Chromium, node or playwright-core is missing.
--update writes the pictures' reference anew: look at the page first.
"""
import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--lod", required=True)
    parser.add_argument("--npm", required=True, type=Path)
    parser.add_argument("--update", action="store_true")
    args = parser.parse_args()
    lod = Path(shutil.which(args.lod) or args.lod).resolve()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not (chromium and shutil.which("node") and (args.npm / "node_modules/playwright-core").is_dir()):
        print("NOT RUN: needs chromium, node and playwright-core (tools/install test, tools/npm_install)")
        return 77
    with tempfile.TemporaryDirectory(prefix="lodestone-report-") as folder:
        scratch = Path(folder)
        for words in (["sample", "statue", "--triangles", "20000", "-o", "statue.ply"],
                      ["build", "statue.ply", "-o", "statue.glb", "--levels", "3", "--image-error", "--report", "statue.html"]):
            subprocess.run([lod, *words, "-q"], cwd=scratch, check=True, stdout=subprocess.DEVNULL)
        command = ["node", HERE / "report_browser.mjs", args.npm.resolve(), chromium, scratch / "statue.html",
                   HERE / "report_pictures.json", *(["--update"] if args.update else [])]
        return subprocess.run(command, timeout=300).returncode


if __name__ == "__main__":
    sys.exit(main())
