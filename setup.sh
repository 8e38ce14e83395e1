#!/usr/bin/env bash
# Sets up .venv with the locked versions, with uv if installed, else with pip. It can be run again.
# PYTHON=python3.12 ./setup.sh chooses the interpreter.
set -euo pipefail
cd "$(dirname "$0")"

say() { printf '%s\n' "$*" >&2; }

# Prints the first suitable Python: $PYTHON, python3, or a versioned one.
find_python() {
    local candidate
    for candidate in ${PYTHON:-} python3 python3.14 python3.13 python3.12 python3.11; do
        if "$candidate" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] < (3, 15))' 2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
    say "Hearth needs Python 3.11 to 3.14, which is not installed. Debian, Ubuntu: apt-get install python3 python3-venv"
    exit 1
}

can_install() { [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; }

# Installs system packages if allowed; otherwise fails, and the caller prints the command.
apt_install() {
    can_install || return 1
    say "Installing $* with apt"
    export DEBIAN_FRONTEND=noninteractive
    timeout 180 apt-get update -qq >/dev/null && timeout 300 apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

make_venv() {
    local python version
    python=$(find_python)
    # The commands of .venv name its folder, and run the code of that folder wherever .venv is copied or moved to.
    if [ -s .venv/.ready ] && [ "$(cat .venv/.ready)" != "$(pwd -P)" ]; then
        say "Making .venv anew: it was set up in $(cat .venv/.ready)"
        rm -rf .venv
    fi
    if [ -x .venv/bin/python ] && .venv/bin/python -c '' 2>/dev/null; then return; fi
    rm -rf .venv
    if command -v uv >/dev/null && uv venv -q --seed --python "$(command -v "$python")" .venv; then return; fi
    if "$python" -m venv .venv >/dev/null 2>&1; then return; fi
    # On Debian the pip of venv is in a separate package.
    version=$("$python" -c 'import sys; print("python%d.%d-venv" % sys.version_info[:2])')
    rm -rf .venv
    if apt_install "$version" && "$python" -m venv .venv; then return; fi
    rm -rf .venv
    say "Python's venv module is not complete. Run: sudo apt-get install $version"
    exit 1
}

with_uv() {
    command -v uv >/dev/null &&
        uv pip install -q --python .venv/bin/python "$@"
}

# Byte code is compiled when a module is first imported; most of these modules are never imported.
with_pip() { .venv/bin/python -m pip install -qq --no-compile --disable-pip-version-check "$@"; }

# Every package, those that build ours too, is what the lock says by its hash; what is another is not installed.
install_packages() {
    with_uv --no-deps --require-hashes -r requirements.lock ||
        with_pip --no-deps --require-hashes -r requirements.lock || refuse
    with_uv --no-deps --no-build-isolation -e . || with_pip --no-deps --no-build-isolation -e . || refuse
}

refuse() {
    say "The locked versions can't be installed, so nothing more is: a file that does not fit its hash, no network, or a"
    say "system without files in the lock. the message above says which. Without the lock, and at your own risk:"
    say "    .venv/bin/python -m pip install -e '.[agents,pictures,web,test]'"
    exit 1
}

# Only rendering needs these; everything else works without them.
install_libraries() {
    local lacking
    lacking=$(.venv/bin/python cli.py doctor --libraries | tr '\n' ' ')
    [ -n "$lacking" ] || return 0
    # shellcheck disable=SC2086
    if ! apt_install $lacking; then
        say "Rendering needs missing system libraries; everything else works. To install them:"
        say "    sudo apt-get install $lacking"
    fi
}

say "Setting up .venv (once; half a minute with uv, a minute or two with pip)"
make_venv
install_packages
install_libraries
pwd -P >.venv/.ready
