#!/usr/bin/env python3
"""Tests of the command `lod` as its users run it.

    cli_test.py [NAME ...] [--lod LOD]      NAME: a class below or Class.test_name; none = all. LOD: the command.
"""
import argparse
import sys
import unittest

import support
from atomic_test import Atomic, Interrupt  # noqa: F401
from axes_test import Axes  # noqa: F401
from batch_test import Batch, Names  # noqa: F401
from control_test import Control  # noqa: F401
from help_test import Help, Shells  # noqa: F401
from ladder_levels_test import LadderLevels  # noqa: F401
from readback_test import Readback  # noqa: F401
from render_test import Render, Sheet  # noqa: F401
from report_test import Report  # noqa: F401
from volume_test import Volumes  # noqa: F401
from voxel_test import Voxels  # noqa: F401
from words_test import Words  # noqa: F401
from result_test import Json, SameBytes, Samples  # noqa: F401
from side_files_test import SideFiles  # noqa: F401
from streams_test import ExitCodes, Foreign, Progress, Streams  # noqa: F401
from target_test import Lengths, Targets  # noqa: F401


def main():
    parser = argparse.ArgumentParser(description="Tests of the command lod.")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--lod", default="lod")
    arguments = parser.parse_args()
    support.use(arguments.lod)
    unittest.main(argv=[sys.argv[0], *arguments.names], verbosity=2)


if __name__ == "__main__":
    main()
