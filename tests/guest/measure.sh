#!/bin/sh
# In the guest, beside its tests: the programs as they are shipped measure a sample on a rig that this
# kernel has by `usbip attach`. The host has the rig (run_guest.sh), and at 10.0.2.100 a port each for what
# it gives and takes: 1 gives the calibrated store, 2 takes what was measured and answers whether it is what
# its twin measured.
#   measure.sh PORT_OF_RIG
export GONIO_STORE=/daemon/store GONIO_CONFIG=/daemon/config
fail() {
    echo "$1"
    cat /tmp/goniod.log /tmp/gonio.log 2>/dev/null
    exit 1
}
now() { cut -d ' ' -f 1 /proc/uptime; }
gonio() { /daemon/gonio --quiet "$@" >/tmp/gonio.out 2>/tmp/gonio.log; }
ip link set eth0 up && ip addr add 10.0.2.15/24 dev eth0 || fail "no network"
nc 10.0.2.100 1 </dev/null | tar -x -C /daemon || fail "no store"
echo "the calibrated store is here after $(now) s"
tries=0 # the rigs of the other tests come and go meanwhile, and one may take the port that is free now
until /daemon/usbip --tcp-port "$1" attach -r 10.0.2.2 -b 1-1 >/tmp/gonio.log 2>&1; do
    tries=$((tries + 1))
    [ $tries -lt 5 ] || fail "usbip attach failed"
done
/daemon/goniod --rig usb:SMALL-1 --profile /daemon/config/rig.toml >/tmp/goniod.log 2>&1 &
daemon=$!
tries=0
until gonio --json status && grep -q '"state": "idle"' /tmp/gonio.out; do
    tries=$((tries + 1))
    [ $tries -lt 60 ] || fail "the daemon and its rig did not find each other"
    sleep 0.5
done
echo "has claimed the rig after $(now) s"
gonio --json measure guest --effort draft || fail "measuring failed"
grep -E '(rig|compute)_seconds' /tmp/gonio.out
grep '"cause"' /tmp/gonio.out && echo "the rig was lost meanwhile, and came back"
file=$(sed -n 's/^ *"file": "\(.*\)",$/\1/p' /tmp/gonio.out)
raw=$(sed -n 's/^ *"raw": "\(.*\)",$/\1/p' /tmp/gonio.out)
[ -s "$raw" ] || fail "no capture is stored"
echo "has measured after $(now) s"
kill -TERM $daemon
wait $daemon || fail "goniod ended with $?"
cat /tmp/goniod.log
echo "has ended after $(now) s"
nc 10.0.2.100 2 <"$file" >/tmp/verdict || fail "the host does not take it"
cat /tmp/verdict
grep -q '^equal' /tmp/verdict || fail "not what its twin measured"
