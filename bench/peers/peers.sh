#!/usr/bin/env bash
# Installs the packages that compare.py or renderers.py needs beside twinray into a folder of their own, and runs it.
#   bench/peers/peers.sh compare FOLDER TWINRAY [option of compare.py...]
#   bench/peers/peers.sh renderers FOLDER references|check|times TARGET [option of renderers.py...]
set -euo pipefail
case ${1-} in
compare) packages=(numpy trimesh python-fcl rtree embreex pyvista pyviewfactor) least=3 ;;
renderers) packages=(numpy scipy mitsuba) least=4 ;;
*) least=$(($# + 1)) ;;
esac
if (($# < least)); then
    sed -n '2,4s/^# *//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
program=$1.py folder=$2
shift 2
if [[ ! -x $folder/bin/python ]]; then python3 -m venv "$folder"; fi
"$folder/bin/pip" install --quiet "${packages[@]}"
"$folder/bin/python" "$(dirname "${BASH_SOURCE[0]}")/$program" "$@"
