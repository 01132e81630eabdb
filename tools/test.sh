#!/usr/bin/env bash
# Installs the packages, builds and runs the tests. `full` also runs those that take minutes: the documentation's site,
# its tutorials and the code of its pages, a shared library, a second CPU driver, non-default layouts, pictures with many
# paths per pixel. `quick` runs the tests that need no device, and those of the accelerators' common contract, in a minute
# on two cores.
#   tools/test.sh [quick|full|release|debug|asan]
# TWINRAY_REQUIRE names the devices without which tests fail instead of skipping:
# default "vulkan,ray_tracing,descriptor_indexing"; with "python" or "docs" the Python package, or the documentation, must
# be built; the latter needs PyPI.
# Ends with a summary by tools/run_tests.py: the slowest tests, the failed ones, and the skipped ones with reasons.
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

# Sanitizers must be loaded before Python; quick does not test Python.
if [[ $preset == release && ${1-} != quick ]]; then with_python=1; fi
build "$preset"
if [[ ${with_python-} ]] && ! python_for_docs >/dev/null && [[ ${TWINRAY_REQUIRE-} == *docs* ]]; then exit 1; fi
section "Tests ($preset)"
export UBSAN_OPTIONS=${UBSAN_OPTIONS-print_stacktrace=1}
export TWINRAY_REQUIRE=${TWINRAY_REQUIRE-vulkan,ray_tracing,descriptor_indexing}
exec tools/run_tests.py "build/$preset" "${which[@]}"
