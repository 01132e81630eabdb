#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages, builds and runs every test; `quick` runs those that need no device, and of the others those of
# the accelerators' common contract, within three minutes on two cores.
#   tools/test.sh [quick|release|debug|asan]
# TWINRAY_REQUIRE names the devices without which tests fail instead of skipping:
# "vulkan,ray_tracing,descriptor_indexing" unless it is set; with "python" or "docs" in it the Python package must be
# built, or the documentation, for which PyPI must be reached.
# The last lines are ctest's summary.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh

preset=${1-release}
which=()
if [[ $preset == quick ]]; then
    preset=release
    which=(--label-regex 'cpu|quick' --exclude-regex '^(install|spirv|samples)\.')
fi
if [[ ! $preset =~ ^(release|debug|asan)$ || $# -gt 1 ]]; then
    echo "usage: tools/test.sh [quick|release|debug|asan]" >&2
    exit 2
fi

# Sanitizers want to be loaded before Python; quick is about other things.
if [[ $preset == release && ${#which[@]} == 0 ]]; then with_python=1; fi
build "$preset"
if [[ ${with_python-} ]] && ! python_for_docs >/dev/null && [[ ${TWINRAY_REQUIRE-} == *docs* ]]; then exit 1; fi
section "Tests ($preset)"
export TWINRAY_REQUIRE=${TWINRAY_REQUIRE-vulkan,ray_tracing,descriptor_indexing}
exec ctest --preset "$preset" "${which[@]}"
