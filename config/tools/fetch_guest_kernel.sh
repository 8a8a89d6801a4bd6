#!/usr/bin/env bash
# The kernel of the guest that tests/guest boots, from the newest linux-image of this Debian:
#   config/tools/fetch_guest_kernel.sh FOLDER
# FOLDER then holds vmlinux, the modules in the order in which they are loaded, `version`, and `modules`,
# for which it was filled; one that is complete is left as it is, one for other modules is filled anew.
# Neither root nor a mounted image is needed, but apt's lists are.
set -euo pipefail
folder=$1
modules=(vhci-hcd usbhid hid-generic e1000)
[ ! -f "$folder/version" ] || [ "$(cat "$folder/modules" 2>/dev/null)" != "${modules[*]}" ] || exit 0

fail() {
    echo "$1" >&2
    exit 1
}
for tool in apt-get dpkg-deb depmod xz; do
    PATH=$PATH:/usr/sbin:/sbin command -v "$tool" >/dev/null || fail "no guest kernel: $tool not found"
done
PATH=$PATH:/usr/sbin:/sbin
mkdir -p "$folder"
work=$(mktemp -d "$folder/fetching.XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"
: >log

# Not by name: it changes with every security update.
package() { apt-cache depends linux-image-amd64 2>/dev/null | awk '/Depends: linux-image-[0-9]/ { print $2; exit }'; }
download() {
    local name
    name=$(package)
    [ -n "$name" ] && apt-get -qq download "$name" >log 2>&1
}
download || { apt-get -qq update >log 2>&1 && download; } ||
    fail "no guest kernel: apt-get download linux-image-amd64's kernel failed: $(tail -n 1 log)"
deb=$(ls ./linux-image-*.deb)

dpkg-deb --fsys-tarfile "$deb" | tar -x --wildcards './boot/vmlinuz-*' './lib/modules/*/modules.*' \
    './lib/modules/*/kernel/drivers/usb/common/*' './lib/modules/*/kernel/drivers/usb/core/*' \
    './lib/modules/*/kernel/drivers/usb/usbip/*' './lib/modules/*/kernel/drivers/hid/hid*' \
    './lib/modules/*/kernel/drivers/hid/usbhid/*' './lib/modules/*/kernel/drivers/net/ethernet/intel/e1000/*'
version=$(ls lib/modules)
depmod -b . "$version" 2>/dev/null

# The ELF inside the bzImage: QEMU then needs not emulate its decompression.
offset=$(LC_ALL=C grep -obUaP -m 1 '\xFD7zXZ\x00' "boot/vmlinuz-$version" | head -n 1 | cut -d : -f 1)
[ -n "$offset" ] || fail "no guest kernel: no xz stream in vmlinuz-$version"
xz -dc --single-stream >vmlinux < <(tail -c "+$((offset + 1))" "boot/vmlinuz-$version" 2>/dev/null)
[ "$(head -c 4 vmlinux | tail -c 3)" = ELF ] || fail "no guest kernel: vmlinuz-$version holds no ELF"

# In the order of loading; unpacked and without debug information.
rm -f ../version ../??-*.ko
number=10
for module in "${modules[@]}"; do
    while read -r word file _; do
        [ "$word" = insmod ] || continue
        name=$(basename "$file")
        name=${name%.xz}
        ! compgen -G "../??-$name" >/dev/null || continue
        case $file in *.xz) xz -dc "$file" >"../$number-$name" ;; *) cp "$file" "../$number-$name" ;; esac
        ! command -v strip >/dev/null || strip --strip-debug "../$number-$name"
        number=$((number + 1))
    done < <(modprobe -d . -S "$version" --show-depends "$module")
done
mv vmlinux ..
echo "${modules[*]}" >../modules
echo "$version" >../version
