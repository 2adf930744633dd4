"""What else the machine is doing while something is measured."""
import os
import pathlib
import time

DISTURBED = 0.05  # processors in use by others from which on times say little

_patience = iter(range(300))  # seconds that one process waits in all


def free_bytes():
    lines = pathlib.Path("/proc/meminfo").read_text().splitlines()
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvailable:"))


def busy_seconds():
    """Of all processors since the machine began: user, nice and system time."""
    return sum(map(int, pathlib.Path("/proc/stat").read_text().split()[1:4])) / os.sysconf("SC_CLK_TCK")


def wait_for_quiet():
    """Until nobody computes, while patience lasts."""
    for _ in _patience:
        busy = busy_seconds()
        time.sleep(1)
        if busy_seconds() - busy < DISTURBED:
            return
