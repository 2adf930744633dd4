"""Help, its examples, the manual page and the completions: all from one table, so all must agree."""
import os
import shutil
import subprocess
import re
from pathlib import Path

from support import Scratch, lod_path, run

VERBS = ["build", "simplify", "measure", "render", "remesh", "voxelize", "boolean", "info", "convert", "sample"]
ALL = VERBS + ["help", "completion"]


def help_of(verb):
    return run("help", verb).stdout


def examples_of(verb):
    block = help_of(verb).split("Examples:\n")[1].split("\n\n")[0]
    return [line.strip() for line in block.splitlines() if line.startswith("  lod ")]


def options_of(verb):
    return re.findall(r"^  (?:-\w, )?(--[a-z-]+)", help_of(verb), re.MULTILINE)


class Help(Scratch):
    def test_overview_lists_the_verbs(self):
        text = self.lod("--help").stdout
        self.assertEqual(text, self.lod("help").stdout)
        listed = re.findall(r"^  (\w+)  +[A-Z]", text, re.MULTILINE)
        self.assertEqual(listed, ALL)

    def test_verb_help_is_one_text_with_sentence_and_three_examples(self):
        for verb in ALL:
            with self.subTest(verb):
                text = self.lod("help", verb).stdout
                self.assertEqual(text, self.lod(verb, "--help").stdout)
                self.assertRegex(text.splitlines()[0], r"^[A-Z].*\.$")
                self.assertEqual(len(examples_of(verb)), 3)
                self.assertLessEqual(max(map(len, text.splitlines())), 100)

    def test_examples_run(self):
        self.prepare()
        environment = dict(os.environ, PATH=f"{Path(lod_path()).resolve().parent}:{os.environ['PATH']}")
        for verb in ALL:
            for example in examples_of(verb):
                with self.subTest(example):
                    done = subprocess.run(["bash", "-c", example], cwd=self.folder, env=environment, capture_output=True)
                    self.assertEqual(done.returncode, 0, done.stderr.decode())

    def prepare(self):
        """The files that examples name."""
        self.lod("sample", "statue", "--triangles", "6000", "-o", "statue.ply")
        self.lod("sample", "tower", "-o", "tower.glb")
        self.lod("sample", "sphere", "--level", "4", "-o", "sphere.glb")
        self.lod("convert", "tower.glb", "tower.ply")
        self.lod("build", "statue.ply", "-o", "statue.glb", "--levels", "2")
        self.lod("simplify", "statue.ply", "-o", "small.ply", "--triangles", "2000")
        (self.folder / "models").mkdir()
        self.lod("sample", "sphere", "-o", "models/sphere.ply")
        self.lod("sample", "terrain", "--triangles", "2000", "-o", "models/terrain.obj")

    def test_options_tell_units_and_defaults(self):
        text = help_of("build")
        self.assertRegex(text, r"--levels N +.*\(levels; default 5\)|--levels N\n? +(?s:.)*?default 5")
        self.assertIn("default 45", text)
        self.assertIn("default 1080", text)
        self.assertIn("one of none, meshopt, draco", text)

    def test_version(self):
        self.assertRegex(self.lod("--version").stdout, r"^lod \d+\.\d+\.\d+\n$")


class Shells(Scratch):
    def script(self, shell):
        path = self.folder / f"lod.{shell}"
        path.write_text(self.lod("completion", shell).stdout)
        return path

    def test_completions_know_every_verb_and_option(self):
        for shell in ("bash", "zsh", "fish"):
            text = self.script(shell).read_text()
            for verb in ALL:
                self.assertIn(verb, text)
                for option in options_of(verb):
                    self.assertIn(option if shell != "fish" else f"-l {option[2:]}", text, f"{shell} {verb}")

    def test_shells_parse_their_scripts(self):
        for shell in ("bash", "zsh", "fish"):
            if shutil.which(shell):
                done = subprocess.run([shell, "-n", self.script(shell)], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""), shell)

    def complete(self, *words):
        """What bash would offer for the last word."""
        quoted = " ".join(f"'{word}'" for word in words)
        code = f"source '{self.script('bash')}'; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; _lod; " \
               'printf "%s\\n" "${COMPREPLY[@]}"'
        return subprocess.run(["bash", "-c", code], cwd=self.folder, capture_output=True, text=True).stdout.split()

    def test_bash_offers_what_fits(self):
        self.assertEqual(self.complete("lod", "bu"), ["build"])
        self.assertEqual(self.complete("lod", "build", "--compress", "m"), ["meshopt"])
        self.assertEqual(self.complete("lod", "sample", "st"), ["statue"])
        self.assertIn("--keep-border", self.complete("lod", "simplify", "--ke"))
        self.assertIn("statue.ply", self.complete("lod", "info", "sta"))

    def test_manual_page_renders_without_complaint(self):
        page = self.folder / "lod.1"
        page.write_text(self.lod("help", "--man").stdout)
        for verb in ALL:
            for option in options_of(verb):
                self.assertIn(option.replace("-", "\\-"), page.read_text())
        if not shutil.which("groff"):
            self.skipTest("no groff")
        done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z", page], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
