"""What the scripts under bench/ share: blocks of docs/benchmarks.md that a script writes, and frames of plots."""
import math
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[1]
DOC = ROOT / "docs/benchmarks.md"


def write_block(name, writer, text):
    """Replaces what stands between <!-- name: written by writer --> and <!-- /name -->."""
    begin, end = f"<!-- {name}: written by {writer} -->\n", f"<!-- /{name} -->"
    before, rest = DOC.read_text().split(begin)
    DOC.write_text(before + begin + "\n" + text.strip("\n") + "\n\n" + end + rest.split(end)[1])


class LogAxis:
    """Values from `low` to `high` along pixels from `begin` to `end`, logarithmic."""

    def __init__(self, low, high, begin, end):
        self.low, self.scale, self.begin = math.log(low), (end - begin) / math.log(high / low), begin

    def __call__(self, value):
        return self.begin + (math.log(value) - self.low) * self.scale


def text(x, y, words, anchor="start", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{words}</text>'


def line(points, more):
    return f'<path d="M{" L".join(f"{x:.1f} {y:.1f}" for x, y in points)}" fill="none" {more}/>'


def svg(width, height, parts):
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">'
    return "\n".join([head, f'<rect width="{width}" height="{height}" fill="white"/>', *parts, "</svg>"]) + "\n"
