# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# The scripts of this folder source it, some by room.sh. It compares what was seen with what a script states, and makes
# a venv with pinned packages of pip.
set -euo pipefail

differs=0

fail() {
    echo "$(basename "$0"): $*" >&2
    exit 1
}

# One line for each thing that is stated. `conclude` ends a script: 0 if all of them were seen.
same() { # what, seen, stated
    if [[ $2 == "$3" ]]; then echo "as stated: $1: $2"; else
        echo "NOT as stated: $1: '$2', not '$3'"
        differs=1
    fi
}
holds() { # what, 1 or 0
    if (($2)); then echo "as stated: $1"; else
        echo "NOT as stated: $1"
        differs=1
    fi
}
conclude() { exit "$differs"; }

# Makes a venv in $folder, which is the working folder from then on, with the first of $pythons that it finds: on the
# PATH or among pyenv's.
: "${pythons:=3.13 3.12}"
python=''
make_venv() { # name, what pip installs
    if [[ -z $python ]]; then find_python; fi
    "$python" -m venv "$1"
    "$1/bin/pip" install --quiet --disable-pip-version-check "${@:2}"
}
find_python() {
    # shellcheck disable=SC2154  # the script's
    trap 'rm -rf "$folder"' EXIT
    cd "$folder"
    local version
    for version in $pythons; do
        for python in "python$version" "${PYENV_ROOT-$HOME/.pyenv}/versions/$version".*[0-9]/bin/python; do
            if "$python" -c "import ensurepip, venv" 2>/dev/null; then return; fi
        done
    done
    fail "needs Python ${pythons// / or }, for which its packages have wheels"
}
