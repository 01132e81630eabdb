#!/usr/bin/env bash
# Fuzzes the readers of files and command lines and the accelerators' interface (docs/fuzzing.md).
#   tools/fuzz.sh [--seconds N | --runs N] [TARGET...]     60 s each; all targets unless some are named
#   tools/fuzz.sh --coverage [TARGET...]                   coverage of the corpus of earlier calls, without fuzzing
# Installs clang (tools/setup.sh fuzz; not with SKIP_APT=1), builds into build/fuzz and keeps the corpus there
# (corpus/), so that a later call continues. A finding's input is left in build/fuzz/findings, and the exit status is 1.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh

# The sources of each target, whose lines are counted.
importers=engine/scene/importers
declare -A readers=(
    [accel]="engine/accel/accel_backend.cpp engine/accel/instances.cpp engine/accel/sync.cpp engine/accel/geometry.cpp
        engine/accel/instance_array.cpp validation/reference/reference_accel.cpp"
    [command]="cli/command/parse.cpp cli/command/values.cpp"
    [csv]="cli/csv_files.cpp $importers/words.cpp"
    [encodings]="engine/core/files.cpp"
    [events]="viewer/events.cpp"
    [exr]="engine/scene/image_formats.cpp"
    [film]="renderer/film_file.cpp"
    [gltf]="$(echo $importers/gltf*.cpp)"
    [hdr]="engine/scene/image.cpp"
    [image]="engine/scene/image.cpp"
    [json]="validation/records/record_json.cpp report/replay/replay.cpp validation/leaks/leak_test.cpp
        cli/kernels/limits.cpp"
    [obj]="$(echo $importers/{obj,mtl,faces}.cpp)"
    [ply]="$(echo $importers/{ply,faces}.cpp)"
    [rays]="engine/scene/ray_file.cpp"
    [rows]="engine/analysis/row_file.cpp"
    [saved_accel]="swtlas/saved.cpp swtlas/check.cpp"
    [stl]="$importers/stl.cpp $importers/faces.cpp"
)

limit=(-max_total_time=60)
is_fuzzing=1
targets=()
while (($#)); do
    case $1 in
    --seconds) limit=(-max_total_time="${2?}") && shift ;;
    --runs) limit=(-runs="${2?}") && shift ;;
    --coverage) is_fuzzing= ;;
    *)
        if [[ -z ${readers[$1]+set} ]]; then
            echo "usage: tools/fuzz.sh [--seconds N | --runs N | --coverage] [TARGET...]; targets: $(
                printf '%s\n' "${!readers[@]}" | sort | xargs)" >&2
            exit 2
        fi
        targets+=("$1")
        ;;
    esac
    shift
done
if ((${#targets[@]} == 0)); then mapfile -t targets < <(printf '%s\n' "${!readers[@]}" | sort); fi

folder=build/fuzz
section "Packages"
tools/setup.sh fuzz
section "Build"
cmake --preset fuzz
cmake --build "$folder" --target "${targets[@]/#/fuzz_}"
section "Inputs to begin with"
python3 tests/fuzz/make_seeds.py "$folder/seeds"
mkdir -p "$folder/findings"

# Prints the text after this word in the last run's log.
figure() { awk -v word="$1" '$1 == word { value = $2 } END { print value + 0 }' "$2"; }

lines_reached() { # target
    local profile=$folder/$1.profraw
    LLVM_PROFILE_FILE=$profile "$folder/bin/fuzz_$1" -runs=0 -timeout=60 "$folder/corpus/$1" >"$folder/$1.coverage" 2>&1 ||
        return 0
    llvm-profdata-19 merge -o "$folder/$1.profdata" "$profile"
    # shellcheck disable=SC2086
    llvm-cov-19 report "$folder/bin/fuzz_$1" -instr-profile="$folder/$1.profdata" ${readers[$1]} |
        awk '$1 == "TOTAL" { printf "%d of %d, %s", $8 - $9, $8, $10 }'
}

table=$folder/table.txt
status=0
printf '%-12s %12s %8s %8s %22s  %s\n' target executions per_s features "lines of the reader" findings >"$table"
for target in "${targets[@]}"; do
    log=$folder/$target.log
    mkdir -p "$folder/corpus/$target"
    if [[ -n $is_fuzzing ]]; then
        section "Fuzz $target"
        options=(-timeout=5 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1)
        # Drivers keep what they allocate for a while, and each such input would be searched for leaks.
        if [[ $target == accel ]]; then options+=(-detect_leaks=0 -max_len=1024); fi
        if [[ -e tests/fuzz/dictionaries/$target.dict ]]; then options+=(-dict="tests/fuzz/dictionaries/$target.dict"); fi
        mkdir -p "$folder/seeds/$target"
        LLVM_PROFILE_FILE=/dev/null "$folder/bin/fuzz_$target" "${options[@]}" "${limit[@]}" \
            -artifact_prefix="$folder/findings/$target-" "$folder/corpus/$target" "$folder/seeds/$target" \
            >"$log" 2>&1 || {
            status=1
            tail -n 40 "$log"
        }
    fi
    touch "$log"
    findings=$(find "$folder/findings" -name "$target-*" | wc -l)
    features=$(grep -o ' ft: [0-9]*' "$log" | tail -n 1 | tr -dc 0-9)
    printf '%-12s %12s %8s %8s %22s  %s\n' "$target" "$(figure stat::number_of_executed_units: "$log")" \
        "$(figure stat::average_exec_per_sec: "$log")" "${features:-0}" "$(lines_reached "$target")" "$findings" >>"$table"
done
section "Result"
cat "$table"
section_end
if ((status)); then echo "fuzz: something was found: its input is in $folder/findings" >&2; fi
exit "$status"
