#!/bin/busybox sh
# The guest's first process: modules, the tests without udevd, then with it, and out. The tests wait more
# than they work: those of a rig, the fault matrix and the daemon's measurement run side by side, each on a
# rig of its own.
/bin/busybox --install -s /bin
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
mkdir -p /run /tmp /scratch
mount -t tmpfs none /scratch  # not over /tmp, where the scripts lie of a source folder under /tmp
export PATH=/bin LD_LIBRARY_PATH=/lib HOME=/scratch TMPDIR=/scratch
# A page that is given back and asked for again costs an emulated processor much.
export GLIBC_TUNABLES=glibc.malloc.mmap_threshold=33554432:glibc.malloc.trim_threshold=268435456
for module in /modules/*.ko; do insmod "$module" || echo "GUEST insmod $module failed"; done
ip link set lo up
now() { cut -d ' ' -f 1 /proc/uptime; }
echo "GUEST ready after $(now) s"
filter=
rig=
for word in $(cat /proc/cmdline); do
    case $word in
        gonio.filter=*) filter=${word#gonio.filter=} ;;
        gonio.rig=*) rig=${word#gonio.rig=} ;;
    esac
done
failed=0
begin() { # NAME COMMAND...: in the background, each of its lines with its name
    local name=$1
    shift
    {
        "$@" 2>&1
        echo "ended with $? after $(now) s" >"/tmp/$name.end"
    } | while IFS= read -r line; do echo "$name: $line"; done &
}
await() { # NAME...: that have begun
    for name in "$@"; do
        until [ -e "/tmp/$name.end" ]; do sleep 0.1; done
        echo "GUEST $name $(cat "/tmp/$name.end")"
        grep -q '^ended with 0 ' "/tmp/$name.end" || failed=1
    done
}
tests() { begin "$1" /guest_test --gtest_color=no "--gtest_filter=$2"; }
[ -z "$rig" ] || begin daemon sh /measure.sh "$rig"
case $filter in
    daemon) ;;
    ?*)
        tests rig "$filter"
        await rig
        ;;
    *)
        tests faults '*GuestFaults*'
        tests rig 'GuestRig.*'
        await faults rig
        udevd --daemon
        tests udevd 'GuestRig.Un*:GuestRig.IsEnum*:GuestUdev.*'
        await udevd
        ;;
esac
[ -z "$rig" ] || await daemon
wait
echo "GUEST_EXIT $failed"
reboot -f
