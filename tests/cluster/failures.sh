#!/usr/bin/env bash
# failures.sh DOCS: the simulation's figures are those that the documentation shows. Exits with 77 where there is no Python.
set -euo pipefail
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
figures=$(python3 "$1/distributed/failures.py")
[[ $(<"$1/distributed.md") == *"$figures"* ]] || { printf 'docs/distributed.md does not show\n%s\n' "$figures" >&2; exit 1; }
