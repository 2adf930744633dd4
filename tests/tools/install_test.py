"""tools/install and tools/demo with a made-up system in PATH: what they would install, as whom, and what they tell."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PLAIN_COMMANDS = ["sh", "env", "sed", "awk", "tr", "grep", "cat", "find", "head", "dirname", "basename"]
LIST = """# comment
[build]
compiler-package   compiler
libone-dev
libtwo-dev
[test]
runner-package     runner
"""


class Install(unittest.TestCase):
    def setUp(self):
        self.home = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.home)
        self.bin = self.home / "bin"
        self.bin.mkdir()
        (self.home / "tools").mkdir()
        shutil.copy(TOP / "tools/install", self.home / "tools")
        (self.home / "tools/apt.txt").write_text(LIST)
        for name in PLAIN_COMMANDS:
            (self.bin / name).symlink_to(shutil.which(name))
        self.command("apt-get", f'echo "apt-get $*" >>{self.home}/log')
        self.system(installed=[], root=True)

    def command(self, name, script):
        (self.bin / name).write_text(f"#!/bin/sh\n{script}\n")
        (self.bin / name).chmod(0o755)

    def system(self, installed, root):
        lines = "".join(f"echo '{package} installed'\n" for package in installed)
        self.command("dpkg-query", lines + "exit 1")  # exit 1: some of the packages are unknown to it
        self.command("id", f"echo {0 if root else 1000}")

    def run_install(self, *sections):
        done = subprocess.run([self.home / "tools/install", *sections], env={"PATH": str(self.bin)},
                              capture_output=True, text=True)
        log = self.home / "log"
        calls = log.read_text().splitlines() if log.exists() else []
        return done.returncode, done.stderr, [call for call in calls if " install " in call]

    def test_installs_only_what_is_missing(self):
        self.command("compiler", "exit 0")
        self.system(installed=["libone-dev"], root=True)
        status, _, calls = self.run_install("build", "test")
        self.assertEqual(status, 0)
        self.assertEqual(len(calls), 1)
        self.assertIn("--no-install-recommends libtwo-dev runner-package", calls[0])
        self.assertNotIn("libone-dev", calls[0])
        self.assertNotIn("compiler-package", calls[0])

    def test_does_nothing_when_all_is_there(self):
        self.command("compiler", "exit 0")
        self.system(installed=["libone-dev", "libtwo-dev"], root=False)
        self.assertEqual(self.run_install("build"), (0, "", []))

    def test_uses_sudo_only_when_not_root(self):
        self.system(installed=[], root=False)
        status, told, calls = self.run_install("build")
        self.assertEqual((status, calls), (1, []))
        self.assertIn("as root, run: apt-get install", told)
        self.command("sudo", f'echo "sudo install $*" >>{self.home}/log; exec "$@"')
        status, _, calls = self.run_install("build")
        self.assertEqual(status, 0)
        self.assertTrue(any(call.startswith("sudo") for call in calls), calls)

    def test_other_systems_are_told_what_to_install(self):
        (self.bin / "dpkg-query").unlink()
        status, told, calls = self.run_install("build")
        self.assertEqual((status, calls), (1, []))
        self.assertIn("libone-dev libtwo-dev", told)

    def test_failed_install_is_an_error(self):
        self.command("apt-get", "exit 100")
        status, told, _ = self.run_install("build")
        self.assertEqual(status, 1)
        self.assertIn("tools/install:", told)

    def test_unknown_section_names_the_known_ones(self):
        for sections in (["nonsense"], []):
            status, told, calls = self.run_install(*sections)
            self.assertEqual((status, calls), (1, []))
            self.assertIn("build test", told)


class Demo(unittest.TestCase):
    def test_input_that_is_not_there_is_told_before_anything_is_installed(self):
        for given in (["no_such.ply"], ["/"]):
            done = subprocess.run([TOP / "tools/demo", *given], capture_output=True, text=True, cwd="/")
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stderr.count("\n"), 1)
            self.assertIn(given[0], done.stderr)

    def test_input_by_environment(self):
        done = subprocess.run([TOP / "tools/demo", ""], capture_output=True, text=True,
                              env={**os.environ, "IN": "no_such.obj"})
        self.assertEqual(done.returncode, 1)
        self.assertIn("no_such.obj: no such file", done.stderr)


if __name__ == "__main__":
    unittest.main()
