#!/usr/bin/env bash
# Builds the programs of python_rays.py for peers that are headers or libraries of C++, from checkouts of them:
#   bench/peers/programs.sh FOLDER [--cubql CHECKOUT] [--deepee CHECKOUT]
# With nvcc the programs use the GPU, and deepeeRT needs it; else cuBQL uses the CPU.
set -euo pipefail
if (($# < 1)) || [[ $1 == -* ]]; then
    sed -n '2,4s/^# *//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
folder=$(realpath -m "$1")
shift
mkdir -p "$folder"
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")

# Writes beside a program what it is.
about() { # program, checkout, what else
    local revision
    revision=$(git -C "$2" rev-parse --short HEAD 2>/dev/null || echo 'of no known revision')
    echo "${2##*/} $revision, $3" >"$folder/$1.about"
}

make_cubql() { # checkout
    if command -v nvcc >/dev/null; then
        nvcc -O3 -std=c++17 -arch=native --extended-lambda --expt-relaxed-constexpr -I"$1" -I"$here/../.." \
            "$here/cubql_rays.cu" -o "$folder/cubql_rays"
        about cubql_rays "$1" "on the GPU"
    else
        c++ -O3 -std=c++17 -march=native -fopenmp -x c++ -I"$1" -I"$here/../.." "$here/cubql_rays.cu" \
            -o "$folder/cubql_rays"
        about cubql_rays "$1" "on the CPU"
    fi
}

make_deepee() { # checkout, with its submodule
    if ! command -v nvcc >/dev/null; then
        echo "programs.sh: deepeeRT needs nvcc: left out" >&2
        return
    fi
    cmake -S "$1" -B "$folder/deepee" -DCMAKE_BUILD_TYPE=Release >"$folder/deepee.log"
    cmake --build "$folder/deepee" --target dprt --parallel >>"$folder/deepee.log"
    mapfile -t libraries < <(find "$folder/deepee" -name 'lib*.a')
    nvcc -O3 -std=c++20 -arch=native -rdc=true -I"$folder/deepee/include" -I"$1/include" -I"$here/../.." \
        "$here/deepee_rays.cu" -Xlinker --start-group "${libraries[@]}" -Xlinker --end-group -lcuda \
        -o "$folder/deepee_rays"
    about deepee_rays "$1" "float64, on the GPU"
}

while (($#)); do
    case $1 in
    --cubql) make_cubql "$(realpath "$2")" ;;
    --deepee) make_deepee "$(realpath "$2")" ;;
    *) echo "programs.sh: no option $1" >&2 && exit 2 ;;
    esac
    shift 2
done
