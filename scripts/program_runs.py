"""What scripts share that run the program for long and compare what it wrote."""

import filecmp
import os
import pathlib
import sys

PAGE_MB = os.sysconf("SC_PAGESIZE") * 1e-6


def resident_mb(pid):
    """The memory of a process; 0 if it has ended."""
    try:
        return int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[1]) * PAGE_MB
    except (FileNotFoundError, IndexError, ProcessLookupError):
        return 0


def open_files(pid):
    """How many files a process has open; 0 if it has ended."""
    try:
        return len(os.listdir(f"/proc/{pid}/fd"))
    except (FileNotFoundError, ProcessLookupError):
        return 0


def compare(first, second):
    """How many files two folders have, which must be the same to the byte; ends the script if not."""
    def files(folder):
        return sorted(str(f.relative_to(folder)) for f in folder.rglob("*") if f.is_file())

    names = files(first)
    if names != files(second):
        sys.exit(f"{second.name}: other files than {first.name}: {set(names) ^ set(files(second))}")
    _, differing, unread = filecmp.cmpfiles(first, second, names, shallow=False)
    if differing or unread:
        sys.exit(f"{second.name}: differs from {first.name}: {(differing + unread)[:5]}")
    return len(names)
