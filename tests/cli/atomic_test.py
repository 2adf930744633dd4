"""Outputs appear whole or not at all, whatever stops the run."""
import re
import resource
import signal
import subprocess
import time
from pathlib import Path

from support import Scratch, lod_path


class Atomic(Scratch):
    statue_triangles = 40000

    def limited(self, *words):
        """Runs lod where no file may grow beyond 100 kB, as on a full disk."""
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))  # noqa: E731
        return self.lod(*words, code=1, preexec_fn=limit)

    def test_full_disk_leaves_nothing(self):
        for output in ("x.glb", "x.gltf", "x.ply", "x.obj", "x.stl", "x.off"):
            with self.subTest(output):
                self.assert_error(self.limited("convert", "statue.ply", "-o", output), output[:2])
                self.assertEqual(self.files(), ["statue.ply"])
        for kind in ("obj", "gltf", "ply"):
            done = self.limited("build", "statue.ply", "-o", f"x_LOD{{level}}.{kind}")
            self.assert_error(done, "lod: x_LOD0.")
            self.assertNotIn(".tmp", done.stderr, "names of ours say nothing to the user")
        self.assertEqual(self.files(), ["statue.ply"])

    def test_existing_file_is_unharmed_when_the_run_fails(self):
        for output in ("x.glb", "x.obj"):
            (self.folder / output).write_text("precious")
            self.limited("convert", "statue.ply", "-o", output)
            self.assertEqual((self.folder / output).read_text(), "precious")
        (self.folder / "bad.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
        self.lod("build", "bad.ply", "-o", "x.glb", code=1)
        self.assertEqual((self.folder / "x.glb").read_text(), "precious")

    def test_existing_file_is_replaced_when_it_works(self):
        (self.folder / "x.glb").write_text("old")
        self.lod("build", "statue.ply", "-o", "x.glb", "--levels", "2")
        self.assertTrue((self.folder / "x.glb").read_bytes().startswith(b"glTF"))
        self.assertEqual(self.files(), ["statue.ply", "x.glb"])

    def test_levels_replace_all_older_files_or_none(self):
        (self.folder / "d").mkdir()
        for name in ("sp_LOD0.ply", "sp_LOD1.ply"):
            (self.folder / "d" / name).write_text("precious")
        (self.folder / "d" / "sp_LOD2.ply").mkdir()
        done = self.lod("build", "statue.ply", "-o", "d/sp_LOD{level}.ply", "--samples", "1000", code=1)
        self.assert_error(done, "d/sp_LOD2.ply", "directory")
        self.assertEqual(self.files("d"), ["sp_LOD0.ply", "sp_LOD1.ply", "sp_LOD2.ply"])
        for name in ("sp_LOD0.ply", "sp_LOD1.ply"):
            self.assertEqual((self.folder / "d" / name).read_text(), "precious")
        (self.folder / "d" / "sp_LOD2.ply").rename(self.folder / "d" / "sp_LOD9.ply")  # in nobody's way
        self.lod("build", "statue.ply", "-o", "d/sp_LOD{level}.ply", "--samples", "1000")
        for level in range(5):
            self.assertTrue((self.folder / "d" / f"sp_LOD{level}.ply").read_bytes().startswith(b"ply"))

    def test_write_protected_files_stay(self):
        for name in ("x.glb", "x.obj", "x_LOD1.obj", "x.png", "x.html"):
            (self.folder / name).write_text("precious")
            (self.folder / name).chmod(0o444)
        self.lod("build", "statue.ply", "-o", "y.glb", "--levels", "2", "--samples", "1000")
        for words in (("convert", "statue.ply", "x.glb"), ("convert", "statue.ply", "-o", "x.obj"),
                      ("build", "statue.ply", "-o", "x_LOD{level}.obj", "--levels", "3", "--samples", "1000"),
                      ("convert", "y.glb", "-o", "x_LOD{level}.obj"), ("render", "statue.ply", "-o", "x.png"),
                      ("build", "statue.ply", "-o", "z.glb", "--levels", "2", "--report", "x.html"),
                      ("sample", "sphere", "-o", "x.glb")):
            with self.subTest(words):
                self.assert_error(self.lod(*words, code=1), "is write-protected", "chmod")
        for name in ("x.glb", "x.obj", "x_LOD1.obj", "x.png", "x.html"):
            self.assertEqual((self.folder / name).read_text(), "precious")
        self.assertEqual(self.files(), ["statue.ply", "x.glb", "x.html", "x.obj", "x.png", "x_LOD1.obj", "y.glb"])

    def test_symbolic_links_are_followed(self):
        (self.folder / "far").mkdir()
        for kind in ("glb", "obj", "gltf"):
            with self.subTest(kind):
                link, target = self.folder / f"link.{kind}", self.folder / "far" / f"real.{kind}"
                target.write_text("old")
                link.symlink_to(f"far/real.{kind}")
                self.lod("convert", "statue.ply", link)
                self.assertTrue(link.is_symlink())
                self.lod("convert", "statue.ply", f"plain.{kind}")
                if kind != "gltf":  # which names its .bin
                    self.assertEqual(target.read_bytes(), (self.folder / f"plain.{kind}").read_bytes())
                self.assertEqual(self.json("info", link)["triangles"], self.statue_triangles)
        (self.folder / "new.ply").symlink_to("far/new.ply")
        self.lod("convert", "statue.ply", "new.ply")
        self.assertTrue((self.folder / "far" / "new.ply").is_file() and (self.folder / "new.ply").is_symlink())
        self.assertEqual(self.files("far"), ["new.ply", "real.glb", "real.gltf", "real.obj"])
        (self.folder / "lost.ply").symlink_to("nowhere/new.ply")
        self.assert_error(self.lod("convert", "statue.ply", "lost.ply", code=1), "lost.ply", "nowhere/new.ply", "folder")

    def test_inputs_are_never_overwritten(self):
        before = (self.folder / "statue.ply").read_bytes()
        self.lod("convert", "statue.ply", "./statue.ply", code=2)
        (self.folder / "link.ply").symlink_to("statue.ply")
        self.lod("simplify", "link.ply", "-o", "statue.ply", "--triangles", "100", code=2)
        (self.folder / "s_LOD1.ply").write_bytes(before)
        self.lod("build", "s_LOD1.ply", "-o", "s_LOD{level}.ply", code=2)
        self.assertEqual((self.folder / "statue.ply").read_bytes(), before)
        self.assertEqual((self.folder / "s_LOD1.ply").read_bytes(), before)


class Interrupt(Scratch):
    statue_triangles = 600000

    @staticmethod
    def handles(pid, number):
        caught = re.search(r"^SigCgt:\s*([0-9a-f]+)", Path(f"/proc/{pid}/status").read_text(), re.M)
        return int(caught[1], 16) >> (number - 1) & 1

    def stop(self, number, wait, *words):
        process = subprocess.Popen([lod_path(), *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(wait)
        while process.poll() is None and not self.handles(process.pid, number):  # on a busy machine it may not have begun
            time.sleep(0.01)
        self.assertIsNone(process.poll(), "ended before it could be stopped")
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
        return process.returncode, out, err

    def test_stops_and_leaves_nothing(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            for wait in (0.05, 0.6):
                with self.subTest((number, wait)):
                    code, out, err = self.stop(number, wait, "build", "statue.ply", "-o", "x.glb", "--samples", "20000000")
                    self.assertEqual((code, out), (130, ""), err)
                    self.assertEqual(len(err.splitlines()), 1, err)
                    self.assertRegex(err, r"^lod: interrupted while [a-z][a-z 0-9,]*, \d+ % done; nothing half done is left\n$")
                    self.assertEqual(self.files(), ["statue.ply"])

    def test_report_and_levels_come_together_or_not_at_all(self):
        """Wherever the signal finds it, most often while levels are drawn."""
        for wait in (1.2, 2.0, 2.8):
            with self.subTest(wait):
                process = subprocess.Popen([lod_path(), "build", "statue.ply", "-o", "x.glb", "--report", "x.html", "--levels", "3"],
                                           cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                time.sleep(wait)
                process.send_signal(signal.SIGINT)
                process.communicate(timeout=60)
                there = {0: ["statue.ply", "x.glb", "x.html"], 130: ["statue.ply"]}
                self.assertEqual(self.files(), there[process.returncode])
                for name in ("x.glb", "x.html"):
                    (self.folder / name).unlink(missing_ok=True)

    def stop_at_once(self, *numbers):
        """Sends signals that all arrive together, as the process sleeps until the last is sent."""
        process = subprocess.Popen([lod_path(), "build", "statue.ply", "-o", "x_LOD{level}.obj", "--samples", "20000000"],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(0.6)
        for number in (signal.SIGSTOP, *numbers, signal.SIGCONT):
            process.send_signal(number)
        _, err = process.communicate(timeout=60)
        return process, err

    def test_second_signal_leaves_nothing_either_and_tells_of_the_third(self):
        process, err = self.stop_at_once(signal.SIGINT, signal.SIGTERM)
        self.assertEqual(process.returncode, 130, err)
        warning = err.splitlines()[0]
        for part in ("lod: ", "third", f".{process.pid}.tmp", f"lod-{process.pid}-"):
            self.assertIn(part, warning)
        self.assertEqual(self.files(), ["statue.ply"])

    def test_third_signal_ends_it(self):
        if signal.getsignal(signal.SIGHUP) == signal.SIG_IGN:
            self.skipTest("run under nohup")
        process, err = self.stop_at_once(signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
        self.assertLess(process.returncode, 0, err)

    def test_samples_stop_too(self):
        for name in ("statue", "terrain"):
            code, out, _ = self.stop(signal.SIGINT, 0.3, "sample", name, "--triangles", "50000000", "-o", "x.glb")
            self.assertEqual((code, out), (130, ""))
            self.assertEqual(self.files(), ["statue.ply"])

    def test_folder_made_for_a_batch_goes_too(self):
        code, _, _ = self.stop(signal.SIGINT, 0.4, "build", "statue.ply", "-o", "lods/", "--samples", "20000000")
        self.assertEqual(code, 130)
        self.assertEqual(self.files(), ["statue.ply"])
