"""tools/check_layers on scratch trees: each kind of violation is caught with file, line, include and rule."""
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]

TABLE = """
[modules]
1 base
2 math base
3 core 1-2
3 runtime math base/check.h
4 spatial 1-3
4 io 1-3
5 simplify 1-3 spatial
9 app 1-8

[folders]
io/gltf plain
io/plain
simplify/collapse
simplify/fit

[libraries]
tl/* base/result.h
fmt/* *.cpp
CLI/* app/*
nlohmann/* io/gltf/*
"""

CLEAN = {
    "lodestone/base/result.h": "#pragma once\n#include <string>\n#include <tl/expected.hpp>\n",
    "lodestone/base/check.h": "#pragma once\n",
    "lodestone/math/vec.h": '#pragma once\n#include "lodestone/base/result.h"\n',
    "lodestone/core/mesh.h": '#pragma once\n#include "lodestone/math/vec.h"\n',
    "lodestone/core/mesh.cpp": '#include "lodestone/core/mesh.h"\n#include <fmt/format.h>\n',
    "lodestone/runtime/choice.h": '#pragma once\n#include "lodestone/base/check.h"\n#include "lodestone/math/vec.h"\n',
    "lodestone/spatial/bvh.h": '#pragma once\n#include "lodestone/core/mesh.h"\n',
    "lodestone/io/gltf/gltf_detail.h": "#pragma once\n#include <nlohmann/json_fwd.hpp>\n",
    "lodestone/io/plain/ply.h": "#pragma once\n",
    "lodestone/io/gltf/read.cpp": '#include "lodestone/io/gltf/gltf_detail.h"\n#include <nlohmann/json.hpp>\n',
    "lodestone/simplify/collapse/edge_collapse.h": '#pragma once\n#include "lodestone/spatial/bvh.h"\n',
    "lodestone/simplify/fit/tracked_level.h": "#pragma once\n",
    "app/main.cpp": '#include <CLI/CLI.hpp>\n#include "lodestone/simplify/collapse/edge_collapse.h"\n',
}


class CheckLayers(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "tools").mkdir()
        (self.root / "tools/layers.txt").write_text(TABLE)
        for name, text in CLEAN.items():
            self.write(name, text)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def run_tool(self):
        done = subprocess.run([TOP / "tools/check_layers", self.root], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def assert_caught(self, name, text, *words):
        self.write(name, text)
        status, out = self.run_tool()
        self.assertEqual(status, 1, out)
        lines = out.splitlines()
        self.assertEqual(len(lines), 1, out)
        for word in words:
            self.assertIn(word, lines[0])

    def test_clean_tree_passes(self):
        status, out = self.run_tool()
        self.assertEqual(status, 0, out)

    def test_module_above(self):
        self.assert_caught("lodestone/core/weld.cpp", '\n\n#include "lodestone/spatial/bvh.h"\n',
                           "lodestone/core/weld.cpp:3", "lodestone/spatial/bvh.h", "core (layer 3) may include 1-2")

    def test_module_beside(self):
        self.assert_caught("lodestone/io/plain/ply.cpp", '#include "lodestone/spatial/bvh.h"\n',
                           "lodestone/io/plain/ply.cpp:1", "io (layer 4) may include 1-3")

    def test_module_two_layers_down_only_by_name(self):
        self.assert_caught("lodestone/simplify/a.cpp", '#include "lodestone/io/gltf.h"\n', "there is no such file")
        self.write("lodestone/io/gltf.h", "#pragma once\n")
        self.assert_caught("lodestone/simplify/a.cpp", '#include "lodestone/io/gltf.h"\n',
                           "simplify (layer 5) may include 1-3, spatial")

    def test_folder_beside(self):
        self.assert_caught("lodestone/simplify/fit/tracked_level.h", '#pragma once\n#include "lodestone/simplify/collapse/edge_collapse.h"\n',
                           "lodestone/simplify/fit/tracked_level.h:2", "simplify/fit may include no other folder of its module")
        self.write("lodestone/simplify/fit/tracked_level.h", "#pragma once\n")
        self.assert_caught("lodestone/io/plain/ply.cpp", '#include "lodestone/io/gltf/gltf_detail.h"\n', "io/plain may include")

    def test_folder_that_may_be_seen_and_files_beside_the_folders(self):
        self.write("lodestone/io/gltf/materials.cpp", '#include "lodestone/io/plain/ply.h"\n')
        self.write("lodestone/io/read.cpp", '#include "lodestone/io/gltf/gltf_detail.h"\n')
        status, out = self.run_tool()
        self.assertEqual(status, 0, out)

    def test_table_that_names_what_is_not_there(self):
        for section, line, word in [("[modules]", "5 refine 1-3", "no module 'refine'"),
                                    ("[folders]", "io/images", "no folder 'io/images'"),
                                    ("[libraries]", "draco/* io/draco.cpp", "no file includes draco/*")]:
            with self.subTest(line):
                (self.root / "tools/layers.txt").write_text(TABLE.replace(section, f"{section}\n{line}"))
                self.assert_caught("lodestone/core/a.cpp", "", "tools/layers.txt", word)

    def test_runtime_sees_one_header_of_base(self):
        self.assert_caught("lodestone/runtime/choice.h", '#pragma once\n#include "lodestone/base/result.h"\n',
                           "runtime (layer 3) may include math, base/check.h")

    def test_library_knows_no_command(self):
        self.write("app/output/table.h", "#pragma once\n")
        self.assert_caught("lodestone/io/plain/ply.cpp", '#include "app/output/table.h"\n', "io (layer 4) may include")

    def test_library_in_the_wrong_file(self):
        for name, header, word in [
            ("lodestone/core/a.cpp", "nlohmann/json.hpp", "io/gltf/*"),
            ("lodestone/io/plain/ply.cpp", "nlohmann/json.hpp", "io/gltf/*"),
            ("lodestone/core/b.cpp", "tl/expected.hpp", "base/result.h"),
            ("lodestone/simplify/a.cpp", "CLI/CLI.hpp", "app/*"),
        ]:
            with self.subTest(header=header):
                self.assert_caught(name, f"#include <{header}>\n", f"{name}:1", header, word, "only")
                (self.root / name).unlink()

    def test_library_in_a_public_header(self):
        self.assert_caught("lodestone/core/text.h", "#pragma once\n#include <fmt/format.h>\n", "*.cpp only")

    def test_unknown_library(self):
        self.assert_caught("lodestone/core/a.cpp", "#include <boost/any.hpp>\n", "boost/any.hpp", "not in the table")

    def test_private_header_of_another_module(self):
        self.assert_caught("app/inspect.cpp", '#include "lodestone/io/gltf/gltf_detail.h"\n', "private to its module, io")

    def test_public_header_that_needs_a_private_one(self):
        self.assert_caught("lodestone/io/gltf.h", '#pragma once\n#include "lodestone/io/gltf/gltf_detail.h"\n',
                           "lodestone/io/gltf.h:2", "not installed")

    def test_relative_include(self):
        self.assert_caught("lodestone/core/a.cpp", '#include "mesh.h"\n', 'included as "lodestone/<module>/<file>.h"')

    def test_circle(self):
        self.write("lodestone/core/a.h", '#pragma once\n#include "lodestone/core/b.h"\n')
        self.assert_caught("lodestone/core/b.h", '#pragma once\n#include "lodestone/core/a.h"\n', "circle",
                           "lodestone/core/a.h -> lodestone/core/b.h -> lodestone/core/a.h")

    def test_header_without_pragma_once(self):
        self.assert_caught("lodestone/core/a.h", "#ifndef A\n#define A\n#endif\n", "lodestone/core/a.h", "#pragma once")

    def test_unknown_module(self):
        self.assert_caught("lodestone/misc/a.cpp", "#include <string>\n", "lodestone/misc/a.cpp", "no module")

    def test_numbers_by_the_locale(self):
        for word, line in [("strtod", "double x = std::strtod(text, &end);"), ("atof", "return std::atof(text);"),
                           ("stod", "x = std::stod(text);"), ("sscanf", 'std::sscanf(text, "%lf", &x);'),
                           ("istringstream", "std::istringstream in(text);"),
                           ("snprintf", 'std::snprintf(text, 9, "%.3g", x);'),
                           ("{:L}", 'fmt::format("{:L}", x);')]:
            with self.subTest(word):
                self.assert_caught("lodestone/core/a.cpp", f"\n{line}\n", f"lodestone/core/a.cpp:2: {word} ", "locale")
        self.write("lodestone/core/a.cpp", '// no strtod here\nint strtodo = 0;\nstd::fprintf(stderr, "%s %d\\n", a, 1);\n'
                                           "auto n = std::strtoull(text, nullptr, 10);\n")
        status, out = self.run_tool()
        self.assertEqual(status, 0, out)

    def test_nothing_to_check_is_an_error(self):
        shutil.rmtree(self.root / "lodestone")
        shutil.rmtree(self.root / "app")
        status, out = self.run_tool()
        self.assertEqual(status, 1, out)


if __name__ == "__main__":
    unittest.main()
