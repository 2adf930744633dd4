"""tools/check in a scratch tree with made-up steps: one failing step fails all, and its name is told."""
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]


class Check(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "tools").mkdir()
        shutil.copy(TOP / "tools/check", self.root / "tools")
        self.bin = self.root / "bin"
        self.bin.mkdir()
        for name in ("tools/check_layers", "tools/format", "tools/fuzz", "bin/cmake", "bin/ctest"):
            self.script(name, 0)

    def script(self, name, status):
        path = self.root / name
        path.write_text(f"#!/bin/sh\necho \"{name} $*\" >>{self.root}/log\nexit {status}\n")
        path.chmod(0o755)

    def run_check(self, *steps):
        (self.root / "log").unlink(missing_ok=True)
        done = subprocess.run([self.root / "tools/check", *steps], env={"PATH": f"{self.bin}:/usr/bin:/bin"},
                              capture_output=True, text=True)
        log = self.root / "log"
        return done, log.read_text() if log.exists() else ""

    def test_all_steps_run_in_order(self):
        done, log = self.run_check("format", "layers", "fuzz")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(log.split("\n")[:2], ["tools/format ", "tools/check_layers "])
        self.assertIn("tools/fuzz 20", log)
        self.assertIn("all passed", done.stdout)

    def test_one_failing_step_fails_all_and_is_named(self):
        self.script("tools/check_layers", 1)
        for steps in (["layers", "format"], ["format", "layers"], ["layers"]):
            done, _ = self.run_check(*steps)
            self.assertNotEqual(done.returncode, 0)
            self.assertNotIn("all passed", done.stdout)
            self.assertIn("layers failed", done.stderr)

    def test_failing_build_or_tests_fail_a_step(self):
        for tool in ("bin/cmake", "bin/ctest"):
            self.script(tool, 1)
            for step in ("unit", "asan"):
                done, _ = self.run_check(step)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(f"{step} failed", done.stderr)
            self.script(tool, 0)

    def test_fast_and_full_name_steps_that_exist(self):
        text = (self.root / "tools/check").read_text()
        for line in text.splitlines():
            if line.startswith(("fast=", "full=")):
                for step in line.split('"')[1].split():
                    self.assertIn(f"step_{step}()", text)

    def test_unknown_step_or_none_prints_the_steps(self):
        for steps in (["nonsense"], [], ["layers", "nonsense"]):
            done, log = self.run_check(*steps)
            self.assertEqual((done.returncode, log), (2, ""))
            self.assertIn("asan", done.stderr)


if __name__ == "__main__":
    unittest.main()
