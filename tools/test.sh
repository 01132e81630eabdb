#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages, builds and runs the tests. `full` also runs those that take minutes: the documentation's site,
# its tutorials and all that its pages show, a shared library, a second CPU driver, the layouts that are no default,
# pictures of many paths a pixel. `quick` runs those that need no device, and of the others those of the accelerators'
# common contract, in a minute on two cores.
#   tools/test.sh [quick|full|release|debug|asan]
# TWINRAY_REQUIRE names the devices without which tests fail instead of skipping:
# "vulkan,ray_tracing,descriptor_indexing" unless it is set; with "python" or "docs" in it the Python package must be
# built, or the documentation, for which PyPI must be reached.
# The last lines are of tools/run_tests.py: the slowest, what failed, how many were skipped and why.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh

preset=${1-release}
which=(--label-exclude full)
if [[ $preset == quick ]]; then
    which+=(--label-regex 'cpu|quick' --exclude-regex '^(install|spirv|samples|docs)\.')
elif [[ $preset == full ]]; then
    which=()
fi
if [[ $preset =~ ^(quick|full)$ ]]; then preset=release; fi
if [[ ! $preset =~ ^(release|debug|asan)$ || $# -gt 1 ]]; then
    echo "usage: tools/test.sh [quick|full|release|debug|asan]" >&2
    exit 2
fi

# Sanitizers want to be loaded before Python; quick is about other things.
if [[ $preset == release && ${1-} != quick ]]; then with_python=1; fi
build "$preset"
if [[ ${with_python-} ]] && ! python_for_docs >/dev/null && [[ ${TWINRAY_REQUIRE-} == *docs* ]]; then exit 1; fi
section "Tests ($preset)"
export UBSAN_OPTIONS=${UBSAN_OPTIONS-print_stacktrace=1}
export TWINRAY_REQUIRE=${TWINRAY_REQUIRE-vulkan,ray_tracing,descriptor_indexing}
exec tools/run_tests.py "build/$preset" "${which[@]}"
