#!/usr/bin/env bash
# failures.sh DOCS: the simulation's figures are those that the documentation shows. Exits with 77 where there is no Python.
set -euo pipefail
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
figures=$(python3 "$1/guide/slurm/failures.py")
[[ $(<"$1/guide/machines.md") == *"$figures"* ]] || { printf 'docs/guide/machines.md does not show\n%s\n' "$figures" >&2; exit 1; }
