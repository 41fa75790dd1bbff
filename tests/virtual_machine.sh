# A virtual machine with Debian's kernel, for tests of what only a kernel has; read with `.` by scripts that then call, in this order,
# machine_begin, machine_module, machine_run. Programs of the tests run in it as they were built here: the whole disk is there to read.
#   DANCE_TEST_QEMU=1       fetches the kernel's package with apt-get download (70 MB, once, into ~/.cache/dance)
#   DANCE_TEST_KERNEL=FILE  takes this linux-image-….deb
# Without either it takes what was fetched before, or the test is skipped.
skip() { echo "[  SKIPPED ] $*"; exit 0; }

# machine_begin FOLDER…: the kernel, and its modules below those folders of lib/modules/…/kernel.
machine_begin() {
  local cache=${XDG_CACHE_HOME:-$HOME/.cache}/dance program name folder
  for program in qemu-system-x86_64:qemu-system-x86 cpio:cpio busybox:busybox-static dpkg-deb:dpkg; do
    command -v "${program%%:*}" >/dev/null || skip "${program%%:*} is not here: apt-get install ${program##*:}"
  done
  [ "$(uname -m)" = x86_64 ] || skip "the guest is an x86_64, this machine is not"
  machine_package=${DANCE_TEST_KERNEL:-$(ls "$cache"/linux-image-*-amd64_*.deb 2>/dev/null | tail -n 1 || true)}
  if [ -z "$machine_package" ]; then
    [ -n "${DANCE_TEST_QEMU:-}" ] || skip "no kernel to boot: DANCE_TEST_QEMU=1 lets this test fetch Debian's (70 MB)"
    name=$(apt-cache depends linux-image-amd64 2>/dev/null | sed -n 's/.*Depends: \(linux-image-[0-9][^ ]*\)/\1/p' | head -n 1)
    [ -n "$name" ] || skip "apt knows no linux-image-amd64: apt-get update"
    mkdir -p "$cache"
    (cd "$cache" && apt-get download "$name" >/dev/null 2>&1) || skip "$name cannot be fetched: apt-get update"
    machine_package=$(ls "$cache"/linux-image-*-amd64_*.deb | tail -n 1)
  fi
  [ -f "$machine_package" ] || { echo "$machine_package: there is no such file"; exit 1; }
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  mkdir -p "$work/kernel" "$work/root/bin" "$work/root/modules"
  local wanted=('./boot/vmlinuz-*')
  for folder in drivers/virtio fs net/9p lib "$@"; do wanted+=("./lib/modules/*/kernel/$folder/*"); done
  dpkg-deb --fsys-tarfile "$machine_package" | tar -x -C "$work/kernel" --wildcards "${wanted[@]}"
  machine_loaded=""
  for name in virtio_pci 9pnet_virtio 9p; do machine_with_needs "$name"; done
}

# A module and before it what it needs, each once; what is not there is built into the kernel.
machine_with_needs() {
  local name=${1//-/_} file need
  case " $machine_loaded " in *" $name "*) return ;; esac
  file=$(find "$work/kernel/lib" -name "$name.ko" -o -name "${name//_/-}.ko" | head -n 1)
  [ -n "$file" ] || return 0
  for need in $(tr '\0' '\n' <"$file" | sed -n 's/^depends=//p' | tr , ' '); do machine_with_needs "$need"; done
  machine_loaded="$machine_loaded $name"
  cp "$file" "$work/root/modules/$name.ko"
}

# machine_module NAME [OPTIONS]: one that must be there.
machine_module() {
  machine_with_needs "$1"
  [ -f "$work/root/modules/$1.ko" ] || { echo "$machine_package has no $1"; exit 1; }
  printf %s "${2:-}" >"$work/root/modules/$1.options"
}

# machine_run: boots, loads the modules, runs the script on stdin and keeps what it said in $work/said. In the script, `load MODULE`
# loads one again, `host COMMAND…` runs a program of this machine, whose /tmp is the guest's own.
machine_run() {
  local script
  script=$(cat)
  cp "$(command -v busybox)" "$work/root/bin/busybox"
  cat >"$work/root/init" <<END
#!/bin/busybox sh
/bin/busybox --install -s /bin
mkdir -p /proc /sys /dev /host /tmp
mount -t proc proc /proc; mount -t sysfs sys /sys; mount -t devtmpfs dev /dev; mount -t tmpfs tmp /tmp
load() { insmod /modules/\$1.ko \$(cat /modules/\$1.options 2>/dev/null); }
for module in $machine_loaded; do load \$module || echo "no \$module"; done
mount -t 9p -o trans=virtio,version=9p2000.L,ro,cache=loose,msize=512000 host /host || echo "no host"
for folder in dev proc sys; do mount --bind /\$folder /host/\$folder; done
host() { chroot /host "\$@"; }
echo DANCE-BEGIN
$script
echo DANCE-END
poweroff -f
END
  chmod +x "$work/root/init"
  (cd "$work/root" && find . | cpio -o -H newc --quiet | gzip -1) >"$work/initrd"
  # Emulated, as a virtual machine inside another often cannot boot it otherwise. Nothing to write; no network.
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
}

machine_failed=0
machine_part() { sed -n "/^== $1\$/,/^== /p" "$work/said"; }
# machine_wants PART PATTERN: after the line `== PART` the guest has said so.
machine_wants() {
  machine_part "$1" | grep -qE "$2" || { echo "FAILED: '$1' does not say: $2"; machine_failed=1; }
}
