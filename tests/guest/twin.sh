#!/usr/bin/env bash
# The host's side of the daemon's measurement in the guest:
#   tests/guest/twin.sh BUILD FOLDER    calibrates a rig in virtual time, packs the calibrated store for the
#                                       guest's daemon, and measures the sample as it must
#   tests/guest/twin.sh give FOLDER     what is packed, on stdout, once it is there
#   tests/guest/twin.sh take FOLDER     what the guest measured, from stdin; on stdout whether it is equal
set -euo pipefail
here=$(realpath "$(dirname "$0")")
config=$here/../../config
export GONIO_CONFIG=$config
folder=$2

await() { # FILE: or that it will never be there
    until [ -e "$1" ]; do
        [ ! -e "$folder/failed" ] || exit 1
        sleep 0.1
    done
}

# rows FILE: of a CSV, without what says when and where it was measured.
rows() { grep -v '^#' "$1"; }

# compare A B: each number of each row. In each digit where both processors have the same instructions; where
# one has no FMA, libm's last bits differ, and values by 1.2e-8 as seen (their noise is 1e-3 and more).
compare() {
    paste -d '|' "$1" "$2" | awk -F '|' '
        function fault(why) { printf "different: row %d: %s\n%s\n%s\n", NR, why, $1, $2; bad = 1; exit }
        $1 == $2 { same++; next }
        {
            n = split($1, a, ","); m = split($2, b, ",")
            if (n != m) fault("other columns")
            for (i = 1; i <= n; i++) {
                if (a[i] == b[i]) continue
                size = a[i] < 0 ? -a[i] : a[i]; off = a[i] - b[i]; off = off < 0 ? -off : off
                if (a[i] !~ /^[-+.0-9e]+$/ || b[i] !~ /^[-+.0-9e]+$/ || off > 1e-6 * size) fault("column " i)
                if (off > worst * size) worst = off / size
            }
        }
        END {
            if (bad) exit
            if (NR < 10000) { printf "different: %d rows are no table\n", NR; exit }
            printf "equal: %d rows of a BRDF table, %d of them in each digit, the others to %.1e\n", NR, same, worst
        }'
}

case $1 in
    give)
        await "$folder/store.tar"
        exec cat "$folder/store.tar"
        ;;
    take)
        cat >"$folder/guest.gonio"
        await "$folder/twin.csv"
        "$(cat "$folder/bin")/gonio" --quiet export "$folder/guest.gonio" -o "$folder" --formats csv
        compare <(rows "$folder/guest.csv") <(rows "$folder/twin.csv")
        exit 0
        ;;
esac

bin=$(realpath "$1/bin")
mkdir -p "$folder"
echo "$bin" >"$folder/bin"
daemon=
trap '[ -z "$daemon" ] || kill "$daemon" 2>/dev/null || true; wait; [ -e "$folder/twin.csv" ] || : >"$folder/failed"' EXIT
store=$folder/store
export GONIO_STORE=$store GONIO_SOCKET=$folder/goniod.sock
gonio() { "$bin/gonio" --quiet "$@"; }
begin() {
    "$bin/goniod" --rig sim --profile "$here/rig.toml" &
    daemon=$!
    for _ in $(seq 200); do
        ! gonio status >/dev/null 2>&1 || return 0
        kill -0 "$daemon"
        sleep 0.05
    done
    return 1
}
end() {
    kill "$daemon"
    wait "$daemon"
    daemon=
}
begin
gonio sim place mirror --serial SMALL-1 --seed 11 --systematic none
gonio calibrate mirror
for tile in black white; do
    gonio sim place "$tile"
    gonio calibrate "$tile"
done
echo "calibrated after $SECONDS s"
gonio sim place "$(cat "$here/sample.txt")"
end

# The guest gets the calibrations, without the pictures that they were made of.
mkdir "$folder/other"
mv "$store/sim.json" "$folder/other/"
find "$store" -name '*.graw' -exec mv {} "$folder/other/" \;
tar -c -C "$folder" -f "$folder/store.part" store
mv "$folder/store.part" "$folder/store.tar"
mv "$folder/other/sim.json" "$store/"

begin
gonio measure twin --effort draft -o "$folder/twin.gonio"
mkdir "$folder/exported"
gonio export "$folder/twin.gonio" -o "$folder/exported" --formats csv
end
mv "$folder/exported/twin.csv" "$folder/twin.csv"
echo "measured after $SECONDS s"
