"""What the tests of the command share: a scratch folder with models, and ways to run `lod`."""
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

_lod = "lod"


def use(command):
    """Sets which command is tested; a path may be relative."""
    global _lod
    _lod = os.path.abspath(shutil.which(command) or command)


def lod_path():
    return _lod


def run(*words, cwd=None, **more):
    """Runs lod; standard output and error come as text, bytes that are not UTF-8 as surrogates."""
    return subprocess.run([_lod, *map(os.fspath, words)], cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, encoding="utf-8", errors="surrogateescape", **more)


class Scratch(unittest.TestCase):
    """Each test gets an empty folder with statue.ply (closed, 4,000 triangles) in it."""

    statue_triangles = 4000

    @classmethod
    def setUpClass(cls):
        cls._home = tempfile.TemporaryDirectory(prefix="lod-test-")
        made = run("sample", "statue", "--triangles", str(cls.statue_triangles), "-o", Path(cls._home.name) / "statue.ply")
        assert made.returncode == 0, made.stderr

    @classmethod
    def tearDownClass(cls):
        cls._home.cleanup()

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(dir=self._home.name))
        os.link(Path(self._home.name) / "statue.ply", self.folder / "statue.ply")

    def lod(self, *words, code=0, **more):
        """Runs lod in the scratch folder and holds it to an exit code; None: done, or short of its target."""
        done = run(*words, cwd=self.folder, **more)
        code = done.returncode if code is None and done.returncode in (0, 3) else code
        self.assertEqual(done.returncode, code, f"lod {' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
        return done

    def json(self, *words, code=0):
        return json.loads(self.lod(*words, "--json", code=code).stdout)

    def assert_error(self, done, *parts):
        """One line on standard error that names what it should; nothing on standard output."""
        self.assertEqual(done.stdout, "")
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertTrue(lines[0].startswith("lod: "), lines[0])
        for part in parts:
            self.assertIn(part, lines[0])

    def files(self, folder="."):
        """Names in a folder, hidden ones too."""
        return sorted(os.listdir(self.folder / folder))
