#!/usr/bin/env bash
# Runs every reader under libFuzzer for SECONDS in all, on all cores: tests/fuzz/run.sh TREE SECONDS
# TREE is a build of the preset `asan`. What was found before is kept in TREE/corpus and begun from.
# A failure prints the input's file and how to see it again; exit code 1.
set -uo pipefail
tree=${1:?TREE} seconds=${2:?SECONDS}
words=$(cd "$(dirname "$0")" && pwd)/words
programs=("$tree"/tests/fuzz/fuzz_*)
[ -x "${programs[0]}" ] || {
    echo "fuzz: $tree/tests/fuzz has no programs: cmake --preset asan, build fuzz_programs" >&2
    exit 1
}
cores=$(nproc)
each=$((seconds * cores / ${#programs[@]}))
[ "$each" -gt 1 ] || each=2
# A reader may take 1 s and 50 MiB: one allocation is held against that here, all of them by
# tests/formats/hostile_test.cpp, which counts them. The rest is the sanitizer's own.
export ASAN_OPTIONS=quarantine_size_mb=16:allocator_may_return_null=0 UBSAN_OPTIONS=print_stacktrace=1
export tree each words limits="-timeout=1 -rss_limit_mb=768 -malloc_limit_mb=50"

# fuzz PROGRAM: one reader. What took too long on a busy machine must do so again, alone.
fuzz() {
    local program=$1 reader=${1##*/fuzz_} found log status=0 dictionary=()
    local corpus=$tree/corpus/$reader crashes=$tree/crashes/$reader
    log=$tree/fuzz_$reader.log
    rm -rf "$crashes"
    mkdir -p "$corpus" "$crashes"
    [ ! -f "$words/$reader.dict" ] || dictionary=("-dict=$words/$reader.dict")
    # shellcheck disable=SC2086  # several limits
    "$program" $limits -max_len=1048576 "-max_total_time=$each" "-artifact_prefix=$crashes/" \
        -print_final_stats=1 "${dictionary[@]}" "$corpus" "$tree/tests/fuzz/seeds/$reader" \
        >"$log" 2>&1 || status=$?
    for found in "$crashes"/timeout-*; do
        # shellcheck disable=SC2086
        if [ -f "$found" ] && "$program" $limits "$found" >/dev/null 2>&1; then
            rm "$found"
            status=0
        fi
    done
    if [ "$status" = 0 ]; then
        printf '%-12s %9s inputs, %s a second\n' "$reader" \
            "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
            "$(sed -n 's/^stat::average_exec_per_sec: *//p' "$log")"
        return 0
    fi
    echo "$reader: FAILED"
    grep -E 'ERROR|runtime error|SUMMARY|^ *#[0-9]+ .* in gonio::' "$log" | head -n 12
    for found in "$crashes"/*; do
        [ ! -f "$found" ] || echo "again by: $program -timeout=1 -malloc_limit_mb=50 $found"
    done
    echo "log: $log"
    return 1
}
export -f fuzz
# shellcheck disable=SC2016  # the inner shell's
printf '%s\0' "${programs[@]}" | xargs -0 -P "$cores" -I{} bash -c 'fuzz "$1"' _ {}
