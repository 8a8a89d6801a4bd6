#!/bin/busybox sh
# The guest's first process: modules, the tests without udevd, then with it, and out.
/bin/busybox --install -s /bin
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
mount -t tmpfs none /tmp
mkdir -p /run
export PATH=/bin LD_LIBRARY_PATH=/lib HOME=/tmp
for module in /modules/*.ko; do insmod "$module" || echo "GUEST insmod $module failed"; done
ip link set lo up
echo "GUEST ready after $(cut -d ' ' -f 1 /proc/uptime) s"
failed=0
run() {
    echo "GUEST $1"
    shift
    "$@" || failed=1
}
filter=
for word in $(cat /proc/cmdline); do
    case $word in gonio.filter=*) filter=${word#gonio.filter=} ;; esac
done
run "without udevd" /guest_test --gtest_color=no --gtest_filter="${filter:-GuestRig.*:*GuestFaults*}"
if [ -z "$filter" ]; then
    udevd --daemon
    run "with udevd" /guest_test --gtest_color=no --gtest_filter=GuestRig.Un*:GuestRig.IsEnum*:GuestUdev.*
fi
echo "GUEST done after $(cut -d ' ' -f 1 /proc/uptime) s"
echo "GUEST_EXIT $failed"
reboot -f
