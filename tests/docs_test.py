#!/usr/bin/env python3
"""Holds README.md, CONTRIBUTING.md, CHANGELOG.md, docs/ and examples/ to the truth.

    tests/docs_test.py [--lod PATH] [--compiler CXX] [DOCUMENT…]

- links and the paths in `code` lead to files that exist, anchors to headings;
- every ```cpp block compiles against the library;
- every option that stands in a `lod VERB …` line is one that the verb's help lists;
- every ```sh run block runs in a scratch folder of its document with `lod` in PATH;
- a ```text output block that follows one is what it printed, times and memory aside.
"""
import argparse
import difflib
import re
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
FOLDERS = ("lodestone", "app", "tests", "docs", "tools", "bench", "fuzz", "examples", "cmake", ".ci")
TOP_FILES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE", "Makefile", "CMakeLists.txt", "CMakePresets.json")
FENCE = re.compile(r"^(```+)\s*(.*)$")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)[^)]*\)")
SPAN = re.compile(r"(?<!`)`([^`]+)`(?!`)")


class Document:
    """Text of a document cut into fenced blocks (line, info, text) and the prose around them (line, text)."""

    def __init__(self, path):
        self.path, self.blocks, self.prose = path, [], []
        fence = None
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = FENCE.match(line)
            if fence is None and match:
                fence, info, start, body = match[1], match[2].strip(), number, []
            elif fence is not None and line.strip() == fence:
                self.blocks.append((start, info, "\n".join(body) + "\n"))
                fence = None
            elif fence is not None:
                body.append(line)
            else:
                self.prose.append((number, line))

    def place(self, line):
        return f"{self.path.relative_to(TOP)}:{line}"


def anchors(path):
    """Anchors as GitHub makes them of headings."""
    found = set()
    for _, line in Document(path).prose:
        if line.startswith("#"):
            title = re.sub(r"[`*]", "", line.lstrip("#").strip().lower())
            found.add(re.sub(r"[^\w\- ]", "", title).replace(" ", "-"))
    return found


def check_links(document):
    for number, line in document.prose:
        for target in LINK.findall(SPAN.sub("", line)):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            path = (document.path.parent / name).resolve() if name else document.path
            if not path.exists():
                yield f"{document.place(number)}: link to {target}: no such file"
            elif anchor and anchor not in anchors(path):
                yield f"{document.place(number)}: link to {target}: no such heading"


def check_paths(document):
    for number, line in document.prose:
        for span in SPAN.findall(line):
            for word in span.split():
                word = word.rstrip(".,:;")
                ours = word.startswith(tuple(f + "/" for f in FOLDERS)) or word in TOP_FILES
                if not ours or re.search(r"[*<>{}…$]", word):
                    continue
                if not (TOP / word).exists():
                    yield f"{document.place(number)}: names {word}, which is not there"


def command_lines(document):
    for number, line in document.prose:
        for span in SPAN.findall(line):
            yield number, span
    for start, info, body in document.blocks:
        if info.split()[:1] == ["sh"]:
            for offset, line in enumerate(body.splitlines(), 1):
                yield start + offset, line


def check_options(document, lod, helps={}):
    for number, line in command_lines(document):
        for words in re.split(r"[|;&]", line.split(" # ")[0]):
            words = words.split()
            if words[:1] == ["$"]:
                words = words[1:]
            if len(words) < 2 or Path(words[0]).name != "lod" or not re.fullmatch(r"[a-z-]+", words[1]):
                continue
            verb = words[1]
            if verb not in helps:
                done = subprocess.run([lod, "help", verb], capture_output=True, text=True)
                helps[verb] = done.stdout if done.returncode == 0 else None
            if helps[verb] is None:
                yield f"{document.place(number)}: lod has no help for '{verb}'"
                continue
            for option in re.findall(r"(?<!\S)--?[a-zA-Z][\w-]*", " ".join(words[2:])):
                if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", helps[verb]):
                    yield f"{document.place(number)}: 'lod help {verb}' does not know {option}"


def check_cpp(document, compiler):
    for start, info, body in document.blocks:
        if info.split()[:1] != ["cpp"]:
            continue
        done = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-x", "c++", f"-I{TOP}", "-"], input=body,
                              capture_output=True, text=True)
        if done.returncode != 0:
            yield f"{document.place(start)}: does not compile:\n{done.stderr}"


def steady(text):
    """The lines without what differs from run to run: seconds, also in a table's last column; white space as one blank."""
    lines, timed = [], False
    for line in text.strip().splitlines():
        line = re.sub(r"[\s─-]+", " ", re.sub(r"\b\d+(\.\d+)? ?(s|ms)\b", "TIME", line)).strip()
        lines.append(re.sub(r"\S+$", "TIME", line) if timed and line[:1].isdigit() else line)
        timed = line.endswith(" seconds") or (timed and line[:1].isdigit())
    return lines


def check_runs(document, lod):
    with tempfile.TemporaryDirectory() as scratch:
        printed = None
        for start, info, body in document.blocks:
            if info == "sh run":
                env = {"PATH": f"{Path(lod).parent}:/usr/local/bin:/usr/bin:/bin", "HOME": scratch, "LC_ALL": "C.UTF-8"}
                done = subprocess.run(["sh", "-eu", "-c", body], cwd=scratch, env=env, capture_output=True, text=True)
                printed = done.stdout
                if done.returncode != 0:
                    yield f"{document.place(start)}: exit {done.returncode}:\n{body}{done.stderr}"
                    return
            elif info == "text output":
                if printed is None:
                    yield f"{document.place(start)}: output without a '```sh run' block above it"
                elif steady(printed) != steady(body):
                    shown = "\n".join(difflib.unified_diff(steady(body), steady(printed), "document", "now", lineterm=""))
                    yield f"{document.place(start)}: the command prints something else now:\n{shown}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--lod", help="the built command; without it nothing is run")
    parser.add_argument("--compiler", help="C++ compiler; without it nothing is compiled")
    parser.add_argument("documents", nargs="*", type=Path)
    options = parser.parse_args()
    options.lod = options.lod and str(Path(options.lod).resolve())
    paths = [path.resolve() for path in options.documents] or [
        *(TOP / name for name in TOP_FILES if name.endswith(".md")), *sorted((TOP / "docs").rglob("*.md"))]
    problems = []
    for path in paths:
        document = Document(path)
        problems += [*check_links(document), *check_paths(document)]
        if options.compiler:
            problems += check_cpp(document, options.compiler)
        if options.lod:
            problems += [*check_options(document, options.lod), *check_runs(document, options.lod)]
    print("\n".join(problems) or f"docs: {len(paths)} documents hold")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
