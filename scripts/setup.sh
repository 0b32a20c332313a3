#!/bin/sh
# Makes the environment in the folder named by the first argument. Debian and Ubuntu leave venv out of their Python;
# where it is missing this installs it (as root or with sudo), else it says what to type.
set -eu
venv=$1

python=
for name in python3 python3.13 python3.12 python3.11 python3.10; do
    if command -v "$name" >/dev/null 2>&1 && "$name" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
        python=$name
        break
    fi
done
if [ -z "$python" ]; then
    echo "Fieldhand needs Python 3.10 or newer, and none was found. On Debian 12: apt-get install python3" >&2
    exit 2
fi

make_venv() { "$python" -m venv "$venv" >/dev/null 2>&1; }

if [ ! -x "$venv/bin/python" ] || ! "$venv/bin/python" -m pip --version >/dev/null 2>&1; then
    rm -rf "$venv"
    if ! make_venv; then
        package=$("$python" -c 'import sys; print("python%d.%d-venv" % sys.version_info[:2])')
        echo "Python's venv module is missing: installing $package"
        if [ "$(id -u)" = 0 ]; then
            apt-get update -qq && apt-get install -qq -y "$package" >/dev/null
        elif command -v sudo >/dev/null 2>&1; then
            sudo apt-get update -qq && sudo apt-get install -qq -y "$package" >/dev/null
        else
            echo "Install it as root (apt-get install $package), then run make again." >&2
            exit 2
        fi
        rm -rf "$venv"
        make_venv || { echo "$python -m venv $venv still fails; run it by hand to see why." >&2; exit 2; }
    fi
fi

echo "Setting up Fieldhand in $venv (about a minute the first time)"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[dev]" -e "./benchmarks[dask]"
# Modules and the solver's inner loops are compiled once, here, so that no mission waits for it.
"$venv/bin/python" -m compileall -q src benchmarks/src
"$venv/bin/python" -c "from fieldhand.orienteering.policy import compile_ahead; compile_ahead()"
