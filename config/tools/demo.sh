#!/usr/bin/env bash
# The demonstration: starts the daemon on the simulated rig, calibrates, measures four samples, writes
# exports and plots under out/quickstart/, and prints how far each is from the truth.
# Usage: demo.sh FOLDER_OF_PROGRAMS
set -euo pipefail
bin=$(realpath "${1:?usage: demo.sh FOLDER_OF_PROGRAMS}")
cd "$(dirname "$0")/../.."
out=out/quickstart
gonio=$bin/gonio
rm -rf "$out"
mkdir -p "$out"
export GONIO_STORE=$PWD/$out/store GONIO_CONFIG=$PWD/config
# A short path of its own: a UNIX socket's has at most 107 bytes, and this folder's may be longer.
sockets=$(mktemp -d)
export GONIO_SOCKET=$sockets/goniod.sock

names=(anodised-black oren-nayar plastic metal)
samples=(
    config/demo/AnoBlackEC1onAlum.bsdf
    model:oren-nayar,albedo=0.8,sigma=0.3
    model:lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04
    model:ggx,alpha=0.05,f0=0.9/0.7/0.4
)

"$bin/goniod" --rig sim 2>"$out/goniod.log" &
daemon=$!
finish() {
    kill "$daemon" 2>/dev/null && wait "$daemon" || true
    rm -rf "$sockets"
}
trap finish EXIT
for _ in $(seq 100); do
    "$gonio" status >/dev/null 2>&1 && break
    kill -0 "$daemon" 2>/dev/null || break
    sleep 0.1
done
"$gonio" -q status || {
    cat "$out/goniod.log" >&2
    exit 1
}

total=$((3 + 3 * ${#names[@]}))
done_steps=0
step() { # TEXT COMMAND...: one line of progress, then the command
    local text=$1
    shift
    done_steps=$((done_steps + 1))
    printf '[%2d/%d] %s\n' "$done_steps" "$total" "$text"
    "$@"
}

"$gonio" sim place mirror --seed 1 --serial SIM-0001 --systematic random
step "calibrate: lens map, mirror on nine wedges" "$gonio" calibrate mirror
"$gonio" sim place black
step "calibrate: dark frames and black reference" "$gonio" calibrate black
"$gonio" sim place white
step "calibrate: white reference" "$gonio" calibrate white
"$gonio" -q session new quickstart --notes "four samples of the demonstration"
for i in "${!names[@]}"; do
    name=${names[$i]}
    "$gonio" sim place "${samples[$i]}"
    step "measure $name (${samples[$i]})" "$gonio" measure "$name" -o "$out/$name.gonio"
    step "export  $name as Zemax .bsdf, one file per band, and CSV" \
        "$gonio" export "sample:$name" -o "$out" --formats zemax,csv
    step "plot    $name" "$gonio" plot "sample:$name" -o "$out"
done
"$gonio" -q session close

files=("${names[@]/#/$out/}")
echo
"$gonio" sim score "${files[@]/%/.gonio}" -o "$out/summary.json"
relative=$(realpath --relative-to="$PWD" "$bin")
cat <<END

Written to $out/: .gonio (everything, with uncertainties), .bsdf, .csv, .svg, summary.json

Four commands to try next, from this folder:
    $relative/gonio info $out/metal.gonio
    $relative/gonio report $out/metal.gonio -o $out/metal.html
    $relative/goniod --rig sim --store $out/store &
    $relative/gonio --store $out/store sim place model:ggx,alpha=0.1,f0=0.5 && $relative/gonio --store $out/store measure mine
END
