#!/usr/bin/env python3
"""Checks that functions and files stay short enough to be read in one go.

Usage: scripts/check_lengths.py [--table] [repository]
Prints one line per violation; the exit code is 1 when there is any. --table prints median, p90, p99 and the largest instead.
"""

import re
import subprocess
import sys
from pathlib import Path

MAX_FUNCTION_LINES = 60
MAX_FILE_LINES = 400

# "<file>" or "<file>:<function>" -> why it may be longer.
EXCEPTIONS = {}

NO_BEGINNING = re.compile(r"\s*(//|#|\}|$|(public|protected|private):)")
NOT_A_FUNCTION = re.compile(r"\s*(namespace|struct|class|enum|union|extern|if|for|while|switch|else|do|try|catch|return|case)\b")


def functions(lines):
    """(name, first line, number of lines) of each function. Relies on clang-format: a body ends with the first `}` that is
    indented like the line on which its function begins."""
    start = None
    for index, line in enumerate(lines):
        indent = len(line) - len(line.lstrip())
        if start is None or indent <= start[1]:
            start = None if NO_BEGINNING.match(line) else (index, indent)
        if start is None or not line.rstrip().endswith("{") or indent > start[1] + 4:
            continue
        header = "\n".join(lines[start[0] : index + 1])
        if NOT_A_FUNCTION.match(header) or "(" not in header:
            start = None
            continue
        closing = re.compile(r" {%d}\}" % start[1])
        end = next((i for i in range(index + 1, len(lines)) if closing.match(lines[i])), index)
        name = re.search(r"([\w:~]+)\s*\(", header)
        yield (name.group(1) if name else "?", start[0] + 1, end - start[0] + 1)
        start = None


def tracked(repository, *patterns):
    output = subprocess.run(["git", "ls-files", *patterns], cwd=repository, check=True, capture_output=True, text=True)
    return [repository / name for name in output.stdout.split()]


def measure(repository):
    """All files and all functions as (place, lines)."""
    files, bodies = [], []
    for file in tracked(repository, "*.h", "*.cpp", "*.py"):
        name = str(file.relative_to(repository))
        lines = file.read_text().splitlines()
        files.append((name, len(lines)))
        if file.suffix != ".py":
            bodies += [(f"{name}:{function}", count) for function, _, count in functions(lines)]
    return files, bodies


def print_table(what, measured):
    counts = sorted(count for _, count in measured)
    rank = lambda share: counts[min(len(counts) - 1, int(share * len(counts)))]
    print(f"{what}: {len(counts)}, lines median {rank(0.5)}, p90 {rank(0.9)}, p99 {rank(0.99)}, max {counts[-1]}")


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--table"]
    repository = Path(arguments[0] if arguments else Path(__file__).parent.parent).resolve()
    files, bodies = measure(repository)
    if "--table" in sys.argv:
        print_table("files", files)
        print_table("functions", bodies)
        return 0
    too_long = [(place, count, MAX_FILE_LINES) for place, count in files if count > MAX_FILE_LINES]
    too_long += [(place, count, MAX_FUNCTION_LINES) for place, count in bodies if count > MAX_FUNCTION_LINES]
    problems = [f"{place}: {count} lines, at most {limit}" for place, count, limit in too_long if place not in EXCEPTIONS]
    print("\n".join(problems) or f"lengths: no function over {MAX_FUNCTION_LINES} lines, no file over {MAX_FILE_LINES}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
