#!/usr/bin/env bash
# Builds the documentation site from docs/, the comments of the public headers, the Python package and the command's
# help: build/docs/html/index.html. Fails on any warning and any broken link.
#   tools/docs.sh            installs what is missing and builds twinray first: its programs make pictures and pages
#   tools/docs.sh --check    also checks axe's accessibility rules in a browser (needs npm and chromium)
#   TWINRAY=FILE             uses this command, of a build with samples and Python, and builds nothing
#   SKIP_APT=1               install no package of the system
# Once installed, nothing is fetched.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh

folder=build/docs
site=docs/site
twinray=${TWINRAY-build/release/bin/twinray}

die() {
    printf 'docs: error: %s\n' "$*" >&2
    exit 1
}

# Updates an existing build as it is configured; otherwise makes one without tests.
build_twinray() {
    if [[ -x $twinray ]] && grep -q '^TWINRAY_PYTHON:BOOL=ON' build/release/CMakeCache.txt; then
        cmake --build --preset release
    else
        with_python=1 build docs
    fi
}

# The programs themselves make the pictures at the top of the tutorials, and the gallery.
make_pictures() {
    cmake --build "$(dirname "$(dirname "$twinray")")" --target tutorial_pictures gallery_pictures >/dev/null
}

build_site() {
    $site/doxygen.sh cpp $folder/cpp
    $site/doxygen.sh glsl $folder/glsl
    "$python" $site/stage.py $folder/source "$twinray"
    rm -rf $folder/html
    "$python" -m sphinx -q -W --keep-going -j auto -c docs -d $folder/doctrees $folder/source $folder/html
}

if [[ -z ${TWINRAY-} ]]; then build_twinray; fi
python=$(python_for_docs)
section "Pictures and pages"
make_pictures || die "the pictures of the tutorials and the gallery cannot be made"
build_site
links=$("$python" $site/check_links.py $folder/html $folder/external_links.txt)
if [[ ${1-} == --check ]]; then $site/check_accessibility.sh $folder/html; fi
minutes=$(awk -v seconds=$SECONDS 'BEGIN { printf "%.1f", seconds / 60 }')
pages=$(find $folder/html -name '*.html' | wc -l)
echo "docs: $minutes minutes, $pages pages, warnings 0, $links"
