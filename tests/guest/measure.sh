#!/bin/sh
# The programs as they are shipped, in the guest: a rig that the kernel has by `usbip attach`, the
# daemon on it, and a sample measured from end to end. What it measures is what its twin measured in
# virtual time.
#   measure.sh PORT
gonio="/gonio --store /store --quiet"
fail() {
    echo "$1"
    cat /tmp/*.log
    exit 1
}
ip link set eth0 up
ip addr add 10.0.2.15/24 dev eth0
usbip --tcp-port "$1" attach -r 10.0.2.2 -b 1-1 >/tmp/usbip.log 2>&1 || fail "usbip attach failed"
/goniod --store /store --rig usb --profile /rig.toml >/tmp/goniod.log 2>&1 &
daemon=$!
# The rig and the daemon find each other: until then there is none to measure with.
tries=0
until $gonio measure guest --time-budget 2s 2>/tmp/measure.log; do
    grep -qiE 'no rig|not there|does not run|no daemon|is not running' /tmp/measure.log || fail "measuring failed"
    tries=$((tries + 1))
    [ $tries -lt 40 ] || fail "the rig and the daemon did not find each other"
    sleep 0.5
done
echo "GUEST measured after $(cut -d ' ' -f 1 /proc/uptime) s"
$gonio convert sample:guest /tmp/guest.csv 2>/tmp/convert.log || fail "no CSV"
grep -v '^#' /tmp/guest.csv >/tmp/guest.rows
grep -v '^#' /store/twin.csv >/tmp/twin.rows
cmp /tmp/guest.rows /tmp/twin.rows || fail "not what its twin measured in virtual time"
echo "measured $(wc -l </tmp/guest.rows) rows, each as in virtual time"
kill -TERM $daemon
wait $daemon || fail "goniod ended with $?"
