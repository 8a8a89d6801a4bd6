#!/usr/bin/env bash
# Calibrates the rig that the guest will have, in this process's virtual time, and measures the sample
# once: what the daemon in the guest must measure too.
#   tests/guest/prepare_store.sh BIN STORE
set -euo pipefail
bin=$1
store=$2
here=$(dirname "$0")
sample=$(cat "$here/sample.txt")

"$bin/goniod" --store "$store" --rig sim --profile "$here/rig.toml" &
daemon=$!
trap 'kill "$daemon" 2>/dev/null; wait "$daemon" || true' EXIT
for _ in $(seq 200); do
    [ ! -S "$store/goniod.sock" ] || break
    sleep 0.05
done
gonio() { "$bin/gonio" --store "$store" --yes --quiet "$@"; }
gonio sim place mirror --serial SIM-0042 --seed 11 --systematic none
gonio calibrate mirror
for tile in black white; do
    gonio sim place "$tile"
    gonio calibrate "$tile"
done
# The guest gets the calibrations, and of the sample only what was measured.
cp -r "$store" "$store.calibrated"
gonio sim place "$sample"
gonio measure twin --time-budget 2s
gonio convert sample:twin "$store.calibrated/twin.csv"
trap - EXIT
kill "$daemon"
wait "$daemon" || true
rm -rf "$store"
mv "$store.calibrated" "$store"
rm -f "$store"/*.sock* "$store/sim.json"
find "$store" -name "*.graw" -delete  # what calibrations were made of is not looked at
