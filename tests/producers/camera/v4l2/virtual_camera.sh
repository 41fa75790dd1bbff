#!/usr/bin/env bash
# virtual_camera.sh PROBE: boots Debian's kernel in QEMU with the kernel's own virtual camera (vivid), and runs PROBE, as it was
# built here, against it: it lists the camera, takes pictures in two encodings, is unplugged, and goes on when the
# camera is back. What the preloaded camera cannot show: that a real kernel answers as we think. About a minute.
#   DANCE_TEST_QEMU=1       fetches the kernel's package with apt-get download (70 MB, once, into ~/.cache/dance)
#   DANCE_TEST_KERNEL=FILE  takes this linux-image-….deb
# Without either it takes what it fetched before, or is skipped.
set -euo pipefail
probe=$(realpath "${1:?give the built camera_probe}")
cache=${XDG_CACHE_HOME:-$HOME/.cache}/dance
skip() { echo "[  SKIPPED ] $*"; exit 0; }

for program in qemu-system-x86_64:qemu-system-x86 cpio:cpio busybox:busybox-static dpkg-deb:dpkg; do
  command -v "${program%%:*}" >/dev/null || skip "${program%%:*} is not here: apt-get install ${program##*:}"
done
[ "$(uname -m)" = x86_64 ] || skip "the guest is an x86_64, this machine is not"
package=${DANCE_TEST_KERNEL:-$(ls "$cache"/linux-image-*-amd64_*.deb 2>/dev/null | tail -n 1 || true)}
if [ -z "$package" ]; then
  [ -n "${DANCE_TEST_QEMU:-}" ] || skip "no kernel to boot: DANCE_TEST_QEMU=1 lets this test fetch Debian's (70 MB)"
  name=$(apt-cache depends linux-image-amd64 2>/dev/null | sed -n 's/.*Depends: \(linux-image-[0-9][^ ]*\)/\1/p' | head -n 1)
  [ -n "$name" ] || skip "apt knows no linux-image-amd64: apt-get update"
  mkdir -p "$cache"
  (cd "$cache" && apt-get download "$name" >/dev/null 2>&1) || skip "$name cannot be fetched: apt-get update"
  package=$(ls "$cache"/linux-image-*-amd64_*.deb | tail -n 1)
fi
[ -f "$package" ] || { echo "$package: there is no such file"; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/kernel" "$work/root/bin" "$work/root/modules"
dpkg-deb --fsys-tarfile "$package" |
  tar -x -C "$work/kernel" --wildcards './boot/vmlinuz-*' './lib/modules/*/kernel/drivers/media/*' \
    './lib/modules/*/kernel/drivers/virtio/*' './lib/modules/*/kernel/fs/*' './lib/modules/*/kernel/net/9p/*' \
    './lib/modules/*/kernel/drivers/video/*' './lib/modules/*/kernel/lib/*' './lib/modules/*/kernel/drivers/usb/*'

# A module and before it what it needs, each once; what is not there is built into the kernel.
loaded=""
with_needs() {
  local name=${1//-/_} file need
  case " $loaded " in *" $name "*) return ;; esac
  file=$(find "$work/kernel/lib" -name "$name.ko" -o -name "${name//_/-}.ko" | head -n 1)
  [ -n "$file" ] || return 0
  for need in $(tr '\0' '\n' <"$file" | sed -n 's/^depends=//p' | tr , ' '); do with_needs "$need"; done
  loaded="$loaded $name"
  cp "$file" "$work/root/modules/$name.ko"
}
for module in virtio_pci 9pnet_virtio 9p vivid; do with_needs "$module"; done
[ -f "$work/root/modules/vivid.ko" ] || { echo "$package has no vivid"; exit 1; }

cp "$(command -v busybox)" "$work/root/bin/busybox"
cat >"$work/root/init" <<END
#!/bin/busybox sh
/bin/busybox --install -s /bin
mkdir -p /proc /sys /dev /host /tmp
mount -t proc proc /proc; mount -t sysfs sys /sys; mount -t devtmpfs dev /dev; mount -t tmpfs tmp /tmp
options="n_devs=1 node_types=0x1 num_inputs=1 input_types=0 no_error_inj=0"
for module in $loaded; do
  case \$module in vivid) insmod /modules/vivid.ko \$options ;; *) insmod /modules/\$module.ko ;; esac || echo "no \$module"
done
mount -t 9p -o trans=virtio,version=9p2000.L,ro,cache=loose,msize=512000 host /host || echo "no host"
mount --bind /dev /host/dev; mount --bind /proc /host/proc
p() { chroot /host $probe "\$@"; }
w() { i=0; while ! grep -q "\$1" /tmp/out; do sleep 0.2; i=\$((i+1)); [ \$i -lt 600 ] || break; done; }
echo DANCE-BEGIN
echo "== list"; p --list
p --press /dev/video0 "OSD Text Mode" 2
echo "== YUYV"; p 0 5 120 2>&1
echo "== NV12"; p vivid 3 120 1280x720 NV12 2>&1
echo "== unplugged"
p 0 10 300 back 320x180 YUYV >/tmp/out 2>&1 & child=\$!
w 'picture 1'; p --press /dev/video0 Disconnect 1; w gone
rmmod vivid && echo "pulled out" && insmod /modules/vivid.ko \$options && echo "plugged in"
wait \$child; echo "ended with \$?"; cat /tmp/out
echo DANCE-END
poweroff -f
END
chmod +x "$work/root/init"
(cd "$work/root" && find . | cpio -o -H newc --quiet | gzip -1) >"$work/initrd"

# Emulated, as a virtual machine inside another often cannot boot it otherwise. The whole disk is there to read, nothing to write; no network.
timeout 400 qemu-system-x86_64 -accel tcg -cpu max -m 768 -nodefaults -no-reboot -display none -serial stdio -nic none \
  -kernel "$work"/kernel/boot/vmlinuz-* -initrd "$work/initrd" -append "console=ttyS0 quiet panic=-1 loglevel=3" \
  -fsdev local,id=host,path=/,security_model=none,readonly=on,multidevs=remap \
  -device virtio-9p-pci,fsdev=host,mount_tag=host </dev/null 2>"$work/qemu.txt" | tr -d '\r' >"$work/said" || true
if ! grep -q DANCE-END "$work/said"; then
  echo "the guest did not come to its end:"
  tail -n 40 "$work/said" "$work/qemu.txt"
  exit 1
fi
sed -n '/DANCE-BEGIN/,/DANCE-END/p' "$work/said"

failed=0
# The mean of the test picture's eight bars at three quarters: half of 191 in each colour.
bars='blue (9[0-9]|10[0-2]) green (9[0-9]|10[0-2]) red (9[0-9]|10[0-2])$'
part() { sed -n "/^== $1\$/,/^== /p" "$work/said"; }
wants() { # PART PATTERN
  part "$1" | grep -qE "$2" || { echo "FAILED: '$1' does not say: $2"; failed=1; }
}
wants list '^/dev/video0  vivid  \(platform:vivid-000\)'
wants list '^  YUYV 640x480 .* 25 Hz'
# Larger ones come too slowly to dance by.
wants list '^  taken unless asked otherwise: 640x480 YUYV at 25 Hz'
wants YUYV '^vivid \(/dev/video0\): 640x480 YUYV at 25 Hz'
wants YUYV "^picture 5: 640x480 sequence [0-9]+ $bars"
wants YUYV '^taken 5 .* damaged 0 unplugged 0$'
wants NV12 '^vivid \(/dev/video0\): 1280x720 NV12 at 12.5 Hz'
wants NV12 "^picture 3: 1280x720 sequence [0-9]+ $bars"
for said in '^pulled out' '^plugged in' '^gone' '^back' '^picture 10: 320x180 ' '^taken .* unplugged 1$' '^ended with 0'; do
  wants unplugged "$said"
done
exit $failed
