#!/usr/bin/env bash
# Make .venv from the lock of the running Python and check that gmsh and rendering work.
# Needs only a POSIX system with Python and bash; as root it installs missing system packages.
set -euo pipefail
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}
say() { printf 'install: %s\n' "$*"; }

system_packages=(libgl1 libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1 libgomp1 libegl1)

apt_install() { # what it is for, then the packages
  local purpose=$1
  shift
  if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    say "$purpose: installing the system packages $*"
    if ! { apt-get update -qq && DEBIAN_FRONTEND=noninteractive \
      apt-get install -y -qq --no-install-recommends "$@" >/dev/null; }; then
      say "apt-get could not install them"
      return 1
    fi
  else
    say "$purpose needs system packages; install them with"
    say "  sudo apt-get install --no-install-recommends $*"
    return 1
  fi
}

minor_of() { "$1" -c 'import sys; print("%d%d" % sys.version_info[:2])' 2>/dev/null; }

if ! command -v "$python" >/dev/null; then
  say "there is no $python: install python3, or name one with PYTHON=..."
  exit 2
fi
if ! "$python" -c 'import sys; raise SystemExit(sys.version_info < (3, 11))'; then
  say "$("$python" --version 2>&1) is too old: Python 3.11 or newer is needed (PYTHON=... picks one)"
  exit 2
fi
minor=$(minor_of "$python")
lock=tools/requirements/py$minor.txt
if [ ! -f "$lock" ]; then
  say "no pinned packages for this Python; there are: $(cd tools/requirements && echo py*.txt)"
  exit 2
fi

# an environment of another Python, or one whose making was broken off, is made again
if [ "$(minor_of .venv/bin/python)" != "$minor" ] || ! .venv/bin/python -m pip --version >/dev/null 2>&1; then
  if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
    apt_install "making an environment" python3-venv || exit 2
  fi
  say "making .venv with $("$python" --version)"
  "$python" -m venv --clear .venv
fi
say "installing the pinned packages of $lock (1.8 GB in .venv)"
awk '/^[^ ]/ { wanted = /^uv==/ } wanted' "$lock" >.venv/uv.txt
.venv/bin/python -m pip install -q --disable-pip-version-check --require-hashes -r .venv/uv.txt
# behind a proxy that signs with its own certificate pip has been told of it; uv knows other names
cert=${SSL_CERT_FILE:-${PIP_CERT:-${REQUESTS_CA_BUNDLE:-}}}
if [ -n "$cert" ]; then export SSL_CERT_FILE=$cert; fi
.venv/bin/uv pip install -q --python .venv/bin/python --require-hashes -r "$lock"
# the build tool is pinned too: nothing outside the lock is fetched
.venv/bin/uv pip install -q --python .venv/bin/python --no-deps --no-build-isolation -e .

if ! .venv/bin/python -c 'import gmsh' 2>/dev/null; then
  apt_install "gmsh" "${system_packages[@]}" || exit 2
  .venv/bin/python -c 'import gmsh'
fi
say "gmsh works"
# rendering without its libraries ends in a crash, not in an exception: it is tried in a process of
# its own
if .venv/bin/python -m dentscope.core.rendering >/dev/null 2>&1; then
  say "off-screen rendering works"
else
  say "off-screen rendering does not work here: no pictures of fields in space"
  say "  (the packages for it: ${system_packages[*]})"
fi
touch .venv/.installed
say "ready: .venv/bin/dentscope --help"
