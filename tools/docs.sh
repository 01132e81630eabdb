#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the documentation site from docs/, the comments of the public headers, the Python package and the command's
# help: build/docs/html/index.html. Fails on any warning and any broken link.
#   tools/docs.sh            installs what is missing first: packages of Python into build/docs/venv, Doxygen by apt
#   tools/docs.sh --check    and looks at pages in a browser: axe's rules of accessibility (needs npm and chromium)
#   TWINRAY=FILE             the command, in a build with the samples; default build/release/bin/twinray
#   SKIP_APT=1               install no package of the system
# Once installed, nothing is fetched. Needs python3-venv.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

folder=build/docs
site=docs/site
venv=$folder/venv
twinray=${TWINRAY-build/release/bin/twinray}

die() {
    printf 'docs: error: %s\n' "$*" >&2
    exit 1
}

install_doxygen() {
    if command -v doxygen >/dev/null; then return; fi
    if [[ ${SKIP_APT-} == 1 ]] || ! command -v apt-get >/dev/null; then die "doxygen is not installed"; fi
    local as_root=()
    if ((EUID != 0)); then as_root=(sudo); fi
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends doxygen >/dev/null ||
        die "doxygen cannot be installed: run apt-get update, then this again"
}

install_packages() {
    if cmp -s $site/requirements.txt $venv/installed.txt; then return; fi
    python3 -m venv --clear $venv
    $venv/bin/pip install --quiet --disable-pip-version-check -r $site/requirements.txt
    cp $site/requirements.txt $venv/installed.txt
}

# What the pages of tutorials open with, and the gallery: by the programs themselves.
make_pictures() {
    cmake --build "$(dirname "$(dirname "$twinray")")" --target tutorial_pictures gallery_pictures >/dev/null
}

build_site() {
    $site/doxygen.sh cpp $folder/cpp
    $site/doxygen.sh glsl $folder/glsl
    $venv/bin/python $site/stage.py $folder/source "$twinray"
    rm -rf $folder/html
    $venv/bin/sphinx-build -q -W --keep-going -j auto -c docs -d $folder/doctrees $folder/source $folder/html
}

install_doxygen
install_packages
start=$EPOCHREALTIME
make_pictures || die "the pictures of the tutorials and the gallery cannot be made: build twinray, with its samples, first"
build_site
links=$($venv/bin/python $site/check_links.py $folder/html $folder/external_links.txt)
if [[ ${1-} == --check ]]; then $site/check_accessibility.sh $folder/html; fi
minutes=$(awk -v from="$start" -v to="$EPOCHREALTIME" 'BEGIN { printf "%.1f", (to - from) / 60 }')
pages=$(find $folder/html -name '*.html' | wc -l)
echo "docs: $minutes minutes, $pages pages, warnings 0, $links"
