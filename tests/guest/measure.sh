#!/bin/sh
# The programs as they are shipped, in the guest: a rig that the kernel has, the daemon on it, and a
# sample measured from end to end. What it measures is what its twin measured in virtual time.
gonio="/gonio --store /store --quiet"
sample=$(cat /sample.txt)
fail() {
    echo "$1"
    cat /tmp/*.log
    exit 1
}
/gonio --store /tmp/other sim serve --attach --serial SIM-0042 --seed 11 --systematic none --place "$sample" \
    >/tmp/serve.log 2>&1 &
serve=$!
/goniod --store /store --rig usb --profile /rig.toml >/tmp/goniod.log 2>&1 &
daemon=$!
# The rig and the daemon find each other: until then there is none to measure with.
tries=0
until $gonio measure guest --time-budget 2s 2>/tmp/measure.log; do
    grep -qiE 'no rig|not there|does not run|no daemon' /tmp/measure.log || fail "measuring failed"
    tries=$((tries + 1))
    [ $tries -lt 40 ] || fail "the rig and the daemon did not find each other"
    sleep 0.5
done
$gonio convert sample:guest /tmp/guest.csv 2>/tmp/convert.log || fail "no CSV"
grep -v '^#' /tmp/guest.csv >/tmp/guest.rows
grep -v '^#' /store/twin.csv >/tmp/twin.rows
cmp /tmp/guest.rows /tmp/twin.rows || fail "not what its twin measured in virtual time"
echo "measured $(wc -l </tmp/guest.rows) rows, each as in virtual time"
kill -TERM $daemon
wait $daemon || fail "goniod ended with $?"
kill -TERM $serve
wait $serve || fail "sim serve ended with $?"
