#!/usr/bin/env bash
# Boots Debian's kernel under QEMU and runs the tests of the real USB stack in it:
#   tests/guest/run_guest.sh BUILD [FILTER]
# BUILD is the build tree that holds the programs; FILTER is googletest's, or `daemon` for the daemon's
# measurement alone; without it all are run. Exit code 77 with one line where it cannot run, 1
# with GONIO_REQUIRE_GUEST=1. The kernel is fetched once, into build/guest-kernel.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
build=$1
filter=${2-}
kernel=$source/build/guest-kernel
memory=1024

skip() {
    echo "SKIP guest: $1"
    [ -z "${GONIO_REQUIRE_GUEST-}" ] || { echo "GONIO_REQUIRE_GUEST is set: this is a failure"; exit 1; }
    exit 77
}
for tool in qemu-system-x86_64:qemu-system-x86 busybox:busybox-static cpio:cpio udevadm:udev usbip:usbip; do
    [ -n "$(PATH=$PATH:/usr/sbin:/sbin command -v "${tool%%:*}")" ] ||
        skip "${tool%%:*} not found (apt-get install ${tool#*:})"
done
[ "$(uname -m)" = x86_64 ] || skip "not an x86-64: its programs do not run in the guest"
begin=$(date +%s.%N)
since() { awk -v a="$begin" -v b="$(date +%s.%N)" 'BEGIN { printf "%.1f s", b - a }'; }
why=$("$source/config/tools/fetch_guest_kernel.sh" "$kernel" 2>&1) || skip "${why##*$'\n'}"
echo "kernel $(cat "$kernel/version") there after $(since)"

work=$(mktemp -d)
server=''
measuring=''
finish() {
    [ -z "$measuring" ] || kill "$measuring" 2>/dev/null || true
    [ -z "$server" ] || kill "$server" 2>/dev/null || true
    wait
    rm -rf "$work"
}
trap finish EXIT

# The daemon's part. The rig is simulated here, where no picture is emulated, and the guest attaches to it;
# meanwhile its twin is calibrated and measures in virtual time.
network=()
rig=''
if [ "$filter" = daemon ] || [ -z "$filter" ]; then
    "$source/tests/guest/twin.sh" "$build" "$work/twin" >"$work/twin.log" 2>&1 &
    measuring=$!
    : >"$work/serve.json"
    GONIO_CONFIG=$source/config "$build/bin/gonio" --store "$work/sim" --json sim serve --usbip --port 0 \
        --serial SMALL-1 --seed 11 --systematic none --place "$(cat "$source/tests/guest/sample.txt")" \
        >"$work/serve.json" 2>"$work/serve.log" &
    server=$!
    for _ in $(seq 600); do
        rig=$(sed -n 's/^  "port": \([0-9]*\),*$/\1/p' "$work/serve.json")
        [ -z "$rig" ] || break
        kill -0 "$server" 2>/dev/null || break
        sleep 0.1
    done
    [ -n "$rig" ] || { cat "$work/serve.log"; echo "the rig of the guest's daemon is not served"; exit 1; }
    give="guestfwd=tcp:10.0.2.100:1-cmd:$source/tests/guest/twin.sh give $work/twin"
    take="guestfwd=tcp:10.0.2.100:2-cmd:$source/tests/guest/twin.sh take $work/twin"
    network=(-netdev "user,id=net,restrict=off,$give,$take" -device "e1000,netdev=net,romfile=")
fi

root=$work/root
mkdir -p "$root"/{bin,dev,lib,lib64,modules,proc,sys,tmp,run,var/run,etc/udev/rules.d}
cp "$kernel"/*.ko "$root/modules/"
cp "$(command -v busybox)" "$root/bin/busybox"
cp "$(command -v udevadm)" "$root/bin/udevadm"
ln -s udevadm "$root/bin/udevd"
cp "$source/tests/guest/init.sh" "$root/init"
cp "$source/tests/guest/measure.sh" "$root/"
chmod +x "$root/init"
cp "$source/config/linux/70-gonio.rules" "$root/etc/udev/rules.d/"
# The scripts of the fault matrix, where the program looks for them.
mkdir -p "$root$source/tests/faults"
cp -r "$source/tests/faults/scripts" "$root$source/tests/faults/"
printf 'root:x:0:0::/:/bin/sh\nnobody:x:65534:65534::/:/bin/sh\n' >"$root/etc/passwd"
printf 'root:x:0:\nplugdev:x:46:\nnogroup:x:65534:\n' >"$root/etc/group"
programs=("$build/tests/guest/guest_test" "$build"/bin/{goniod,gonio} "$(PATH=$PATH:/usr/sbin command -v usbip)")
mkdir -p "$root/daemon/config"
cp -r "$source"/config/{rigs,references,quality} "$source/tests/guest/rig.toml" "$root/daemon/config/"
for program in "${programs[@]}"; do
    strip -o "$root/daemon/$(basename "$program")" "$program" 2>/dev/null || cp "$program" "$root/daemon/"
done
mv "$root/daemon/guest_test" "$root/"
# With the libraries that they name, flat in /lib.
ldd "${programs[@]}" "$(command -v udevadm)" | awk '$2 == "=>" && $3 ~ /^\// { print $3 }' | sort -u |
    xargs -I{} cp -L {} "$root/lib/"
cp -L /lib64/ld-linux-x86-64.so.2 "$root/lib64/"
(cd "$root" && find . | cpio -o -H newc --quiet) >"$work/initrd"
echo "image of $(($(stat -c %s "$work/initrd") >> 20)) MiB there after $(since)"

# What costs an emulated processor most, and protects nobody here, is off.
options="quiet panic=-1 nokaslr mitigations=off tsc=reliable init_on_alloc=0 transparent_hugepage=always"
options+=" nowatchdog cryptomgr.notests i8042.nokbd i8042.noaux audit=0 randomize_kstack_offset=off"
accel=tcg
if [ -r /dev/kvm ] && [ -w /dev/kvm ] && grep -qE '^flags.* (vmx|svm)( |$)' /proc/cpuinfo; then accel=kvm; fi
boot() {
    timeout --foreground 300 qemu-system-x86_64 -accel "$1" -M pc -m "$memory" -smp 2 \
        -kernel "$kernel/vmlinux" -initrd "$work/initrd" -pidfile "$work/pid" \
        -append "console=ttyS0 $options ${filter:+gonio.filter=$filter} gonio.rig=$rig" \
        -display none -nodefaults "${network[@]}" -no-reboot -serial stdio </dev/null 2>&1 | sed -u 's/\r$//' | tee "$work/serial"
}
ready() { grep -q '^GUEST ready' "$work/serial"; }
# A KVM that starts and hangs is known: then emulation, which always works.
if [ "$accel" = kvm ]; then
    (
        for _ in $(seq 100); do
            sleep 0.1
            ! ready || exit 0
        done
        kill "$(cat "$work/pid")"
    ) 2>/dev/null &
    boot kvm || true
    ready || echo "NOTE guest: KVM does not boot it; once more by emulation"
fi
[ "$accel" = kvm ] && ready || boot tcg,thread=multi || true
echo "guest ended after $(since)"
exit "$(sed -n 's/^GUEST_EXIT //p' "$work/serial" | grep -E '^[01]$' || echo 1)"
