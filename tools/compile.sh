#!/usr/bin/env bash
# Compile what an impact needs, so that the first command starts at once; quick where it is there.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
printf 'install: compiling what impacts need (a minute, once for each state of the source)\n'
if "$here/.venv/bin/dentscope" impact --new ball >/dev/null &&
  "$here/.venv/bin/dentscope" impact ball.toml --out out >/dev/null 2>&1; then
  printf 'install: compiled\n'
else
  printf 'install: it could not be compiled now; the first command will do it\n'
fi
