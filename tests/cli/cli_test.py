#!/usr/bin/env python3
"""Tests of the command `lod`. Environment: LOD = the command. Arguments: names of classes; none = all."""
import unittest

from atomic_test import Atomic, Interrupt  # noqa: F401
from batch_test import Batch, Names  # noqa: F401
from help_test import Help, Shells  # noqa: F401
from result_test import Json, Lengths, SameBytes, Samples  # noqa: F401
from streams_test import ExitCodes, Foreign, Progress, Streams  # noqa: F401

if __name__ == "__main__":
    unittest.main(verbosity=2)
