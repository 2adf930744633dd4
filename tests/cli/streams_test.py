"""Exit codes, what goes to which stream, the progress bar, foreign formats."""
import fcntl
import os
import pty
import resource
import struct
import subprocess
import termios

from support import Scratch, lod_path, run

TEXT_OFF = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"
DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>
</vertices><triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 1 2 3 2 0 3</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


class ExitCodes(Scratch):
    def test_unknown_option_names_the_nearest(self):
        self.assert_error(self.lod("build", "statue.ply", "-o", "a.glb", "--level", "3", code=2), "'--level'", "--levels")
        self.assert_error(self.lod("simplify", "statue.ply", "--trianglse=9", code=2), "--triangles")
        self.assert_error(self.lod("info", "statue.ply", "-x", code=2), "'-x'")

    def test_unknown_verb_names_the_nearest(self):
        self.assert_error(self.lod("biuld", code=2), "build")
        self.assert_error(self.lod("--json", "build", code=2), "after the verb")

    def test_nothing_at_all_is_help_on_standard_error(self):
        done = self.lod(code=2)
        self.assertEqual(done.stdout, "")
        self.assertIn("Verbs:", done.stderr)

    def test_wrong_command_lines(self):
        build = ("build", "statue.ply")
        for words, part in ((("build",), "needs INPUT"), (build, "-o"), ((*build, "-o", "x.xyz"), ".xyz"),
                            ((*build, "-o", "statue.ply"), "never overwritten"),
                            ((*build, "-o", "x.glb", "--levels", "1"), "at least 2"),
                            ((*build, "-o", "x.glb", "--levels", "many"), "many"),
                            ((*build, "-o", "x.glb", "--levels", "33"), "the limit is 32"),
                            ((*build, "-o", "x.glb", "--levels", "99999999999"), "the limit is 32"),
                            ((*build, "-o", "x.glb", "--levels", "9" * 30), "the limit is 32"),
                            ((*build, "-o", "x.glb", "--levels", "3", "--ratio", "0.5"), "together"),
                            ((*build, "-o", "x.glb", "--ratio", "1.5"), "between 0 and 1"),
                            ((*build, "-o", "x.glb", "--error", "5parsec"), "5parsec"),
                            ((*build, "-o", "x.glb", "--pixels", "2"), "--distances"),
                            ((*build, "-o", "x.glb", "--compress", "zip"), "none, meshopt, draco"),
                            ((*build, "-o", "x.glb", "--threads", "-1"), "--threads"),
                            (("simplify", "statue.ply", "-o", "x.ply"), "target"),
                            (("simplify", "statue.ply", "-o", "x.ply", "--triangles", "9", "--ratio", "0.5"), "one target"),
                            (("measure", "statue.ply"), "needs A B"), (("measure", "a", "b", "c"), "one too many"),
                            (("sample", "stature", "-o", "x.ply"), "statue"), (("info", "."), "directory"),
                            (("completion", "tcsh"), "zsh")):
            with self.subTest(words):
                self.assert_error(self.lod(*words, code=2), part)
        self.assertEqual(self.files(), ["statue.ply"])

    def test_outputs_that_make_no_sense_are_told_before_anything_is_read(self):
        for words in (("simplify", "missing.ply", "-o", "y.ply", "--triangles", "9", "--compress", "draco"),
                      ("convert", "missing.ply", "y.obj", "--compress", "meshopt"),
                      ("build", "missing.ply", "-o", "y_LOD{level}.stl", "--compress", "draco")):
            with self.subTest(words):
                self.assert_error(self.lod(*words, code=2), "no compressed geometry", "--compress")
        self.assert_error(self.lod("build", "missing.ply", "-o", "y.ply", code=2), "one level", "y.ply", "{level}")

    def test_input_that_fails(self):
        (self.folder / "empty.ply").write_bytes(b"")
        (self.folder / "cut.ply").write_bytes((self.folder / "statue.ply").read_bytes()[:2000])
        (self.folder / "folder").mkdir()
        self.assert_error(self.lod("info", "missing.ply", code=1), "missing.ply", "no such file")
        self.assert_error(self.lod("info", "empty.ply", code=1), "empty.ply")
        self.assert_error(self.lod("build", "cut.ply", "-o", "x.glb", code=1), "cut.ply")
        self.assert_error(self.lod("build", "folder", "-o", "out/", code=1), "folder")
        self.assertEqual(self.files(), ["cut.ply", "empty.ply", "folder", "statue.ply"])

    def test_input_that_is_no_file(self):
        (self.folder / "device.ply").symlink_to("/dev/null")
        os.mkfifo(self.folder / "pipe.ply")
        os.mkfifo(self.folder / "pipe.dae")
        for name in ("device.ply", "pipe.ply", "pipe.dae"):
            with self.subTest(name):
                done = self.lod("info", name, code=1, timeout=60)
                self.assert_error(done, f"lod: {name}: is not a regular file", "copy")

    def test_output_that_fails(self):
        (self.folder / "dir.glb").mkdir()
        self.assert_error(self.lod("build", "statue.ply", "-o", "nowhere/x.glb", code=1), "nowhere/x.glb", "folder")
        self.assert_error(self.lod("convert", "statue.ply", "-o", "dir.glb", code=1), "dir.glb")
        if os.geteuid() != 0:
            (self.folder / "closed").mkdir(mode=0o500)
            self.assert_error(self.lod("convert", "statue.ply", "-o", "closed/x.glb", code=1), "closed")

    def test_missed_target_is_written_and_told(self):
        done = self.lod("simplify", "statue.ply", "-o", "x.ply", "--triangles", "1", code=3)
        self.assertTrue((self.folder / "x.ply").exists())
        self.assertIn("lod: statue.ply: ", done.stderr)
        (self.folder / "t.off").write_text(TEXT_OFF)
        done = self.lod("build", "t.off", "-o", "t.glb", code=3)
        self.assertIn("level", done.stderr)
        self.assertTrue((self.folder / "t.glb").exists())

    def test_no_memory_is_one_line(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (100 << 20, 100 << 20))
        if run("--version", preexec_fn=limit).returncode != 0:
            self.skipTest("this build needs more to start")
        self.lod("sample", "statue", "--triangles", "2000000", "-o", "big.ply")
        done = self.lod("build", "big.ply", "-o", "x.glb", "--threads", "1", code=1, preexec_fn=limit)
        self.assert_error(done, "memory")
        self.assertEqual(self.files(), ["big.ply", "statue.ply"])

    def test_output_that_nobody_takes(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([lod_path(), "info", "statue.ply"], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("standard output", done.stderr)

    def test_report_that_nobody_takes(self):
        for output, told in (("x.glb", "x.glb was written"), ("x_LOD{level}.stl", "x_LOD0.stl and 4 more were written")):
            with open("/dev/full", "w") as full:
                words = [lod_path(), "build", "statue.ply", "-o", output]
                done = subprocess.run(words, cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn(told, done.stderr)
            self.assertIn("report could not be", done.stderr)
        self.assertIn("x.glb", self.files())


class Streams(Scratch):
    def test_quiet_success_has_empty_standard_error(self):
        self.assertEqual(self.lod("info", "statue.ply").stderr, "")
        self.assertEqual(self.lod("build", "statue.ply", "-o", "a.glb", "--quiet").stderr, "")

    def test_ratio_says_what_is_kept(self):
        done = self.lod("simplify", "statue.ply", "-o", "a.ply", "--ratio", "10%")
        self.assertIn("keeping 10 % of 4,000", done.stderr)
        self.assertNotIn("keeping", done.stdout)
        quiet = self.lod("simplify", "statue.ply", "-o", "b.ply", "--ratio", "0.1", "--quiet")
        self.assertEqual((quiet.stdout, quiet.stderr), ("", ""))
        self.assertEqual((self.folder / "a.ply").read_bytes(), (self.folder / "b.ply").read_bytes())

    def test_quiet_prints_no_table_but_json_where_it_is_asked_for(self):
        self.lod("simplify", "statue.ply", "-o", "small.ply", "--triangles", "1000")
        for words in (("build", "statue.ply", "-o", "a.glb", "--levels", "2"), ("convert", "statue.ply", "b.glb"),
                      ("sample", "sphere", "-o", "c.ply"), ("render", "statue.ply", "-o", "d.png", "--size", "64x48"),
                      ("render", "a.glb", "--sheet", "-o", "e.png", "--size", "64x48"), ("info", "statue.ply"),
                      ("measure", "statue.ply", "small.ply"), ("voxelize", "statue.ply", "-o", "f.ply", "--resolution", "16")):
            with self.subTest(words):
                self.assertEqual(self.lod(*words, "-q").stdout, "")
                self.assertTrue(self.json(*words, "-q"))
        (self.folder / "more").mkdir()
        self.assertEqual(self.lod("build", "statue.ply", "small.ply", "-o", "more/", "--levels", "2", "-q").stdout, "")
        self.assertIn("Usage", self.lod("help", "build", "-q").stdout)

    def test_figures_of_measure_are_explained_where_they_stand(self):
        self.lod("simplify", "statue.ply", "-o", "small.ply", "--triangles", "1000")
        table = self.lod("measure", "statue.ply", "small.ply").stdout.split("\n\n")[0]
        for figure in ("max", "found", "at most"):
            self.assertRegex(table, rf"(?m)(^|; ){figure}: ")

    def test_table_of_build(self):
        title, *rows = self.lod("build", "statue.ply", "-o", "a.glb").stdout.splitlines()[1:]
        for word in ("level", "triangles", "share", "error", "relative", "1 px from", "bytes", "seconds"):
            self.assertIn(word, title)
        self.assertEqual([row.split()[0] for row in rows[:5]], list("01234"))

    def test_no_colours_in_a_pipe(self):
        done = self.lod("build", "statue.ply", "-o", "a.glb", "--verbose")
        self.assertNotIn("\x1b", done.stdout + done.stderr)

    def test_words_after_dashes_are_inputs(self):
        os.rename(self.folder / "statue.ply", self.folder / "-x.ply")
        self.assertIn("4,000", self.lod("info", "--", "-x.ply").stdout)


class Progress(Scratch):
    statue_triangles = 150000

    def on_terminal(self, *words, columns=80, **variables):
        """Runs lod with a terminal as standard error; returns what came there."""
        try:
            ours, theirs = pty.openpty()
        except OSError as error:  # a chroot without /dev/pts
            self.skipTest(f"no terminal to be had here: {error}")
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        environment = {**os.environ, "TERM": "xterm", **variables}
        process = subprocess.Popen([lod_path(), *words], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=theirs, env=environment)
        os.close(theirs)
        seen = b""
        while True:
            try:
                chunk = os.read(ours, 4096)
            except OSError:
                break
            if not chunk:
                break
            seen += chunk
        os.close(ours)
        self.assertEqual(process.wait(), 0)
        return seen.decode()

    def test_on_a_terminal_with_label_share_and_time_left(self):
        seen = self.on_terminal("build", "statue.ply", "-o", "a.glb", "--samples", "1000000")
        self.assertRegex(seen, r"[a-z]+ \[#*\.*\] +\d+ %")
        self.assertNotRegex(seen, r"\b0 s left")
        self.assertTrue(seen.endswith("\r\033[K"), "the bar is taken away at the end")

    def test_forty_columns_hold_what_is_being_done(self):
        seen = self.on_terminal("build", "statue.ply", "-o", "a.glb", "--levels", "2", columns=40)
        lines = [line.replace("\033[K", "") for line in seen.split("\r")]
        self.assertIn("collapsing", [line.split(" ")[0] for line in lines])
        self.assertLess(max(map(len, lines)), 40)

    def test_no_escape_codes_where_none_are_wanted(self):
        words = ("build", "statue.ply", "-o", "a.glb", "--levels", "2")
        self.assertEqual(self.on_terminal(*words, TERM="dumb"), "")
        plain = self.on_terminal(*words, NO_COLOR="1")
        self.assertIn(" %", plain)
        self.assertNotIn("\033", plain)
        self.assertTrue(plain.endswith(" \r"), "the bar is taken away at the end")

    def test_never_elsewhere_or_when_quiet(self):
        self.assertNotIn("[", self.lod("build", "statue.ply", "-o", "a.glb", "--levels", "2").stderr)
        self.assertEqual(self.on_terminal("build", "statue.ply", "-o", "a.glb", "--levels", "2", "--quiet"), "")


class Foreign(Scratch):
    def test_read_in_a_child(self):
        (self.folder / "t.dae").write_text(DAE)
        before = set(os.listdir("/tmp"))
        done = self.lod("info", "t.dae", "--json")
        self.assertIn('"triangles": 4', done.stdout)
        self.assertFalse({name for name in set(os.listdir("/tmp")) - before if name.startswith("lod-") and "test" not in name})

    def test_garbage_is_an_ordinary_error(self):
        (self.folder / "t.fbx").write_bytes(bytes(range(256)) * 8)
        (self.folder / "t.3ds").write_bytes(b"MM\xff\xff\xff\x7f" + b"=" * 500)
        for name in ("t.fbx", "t.3ds", "missing.fbx"):
            self.assert_error(self.lod("info", name, code=1), name)
