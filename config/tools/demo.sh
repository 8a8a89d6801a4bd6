#!/usr/bin/env bash
# The demonstration: calibrates the simulated rig, measures four samples, writes exports and plots
# under out/quickstart/ and prints how far each is from the truth. Usage: demo.sh PATH_TO_GONIO
set -euo pipefail
gonio=$(realpath "${1:?usage: demo.sh PATH_TO_GONIO}")
cd "$(dirname "$0")/../.."
out=out/quickstart
rm -rf "$out"
mkdir -p "$out"
export GONIO_STORE=$PWD/$out/store GONIO_CONFIG=$PWD/config

names=(anodised-black oren-nayar plastic metal)
samples=(
    config/demo/AnoBlackEC1onAlum.bsdf
    model:oren-nayar,albedo=0.8,sigma=0.3
    model:lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04
    model:ggx,alpha=0.05,f0=0.9/0.7/0.4
)

total=$((3 + 4 * ${#names[@]}))
done_steps=0
step() { # TEXT COMMAND...: one line of progress, then the command
    local text=$1
    shift
    done_steps=$((done_steps + 1))
    printf '[%2d/%d] %s\n' "$done_steps" "$total" "$text"
    "$@"
}

"$gonio" sim place mirror --seed 1 --serial SIM-0001 --systematic random
step "calibrate: lens map, mirror on five wedges" "$gonio" calibrate mirror
"$gonio" sim place black
step "calibrate: dark frames and black reference" "$gonio" calibrate black
"$gonio" sim place white
step "calibrate: white reference" "$gonio" calibrate white
for i in "${!names[@]}"; do
    name=${names[$i]}
    "$gonio" sim place "${samples[$i]}"
    step "measure $name (${samples[$i]})" "$gonio" measure "$name" -o "$out/$name.gonio"
    step "export  $name as Zemax .bsdf, one file per band" \
        "$gonio" convert "$out/$name.gonio" "$out/$name.bsdf"
    step "export  $name as CSV" "$gonio" convert "$out/$name.gonio" "$out/$name.csv"
    step "plot    $name" "$gonio" plot "$out/$name.gonio" -o "$out"
done

files=("${names[@]/#/$out/}")
echo
"$gonio" sim score "${files[@]/%/.gonio}" -o "$out/summary.json"
echo
echo "Written to $out/: .gonio (everything, with uncertainties), .bsdf, .csv, .svg, summary.json"
