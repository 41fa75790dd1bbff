#!/usr/bin/env bash
# virtual_gamepad.sh GAMEPAD HAPTICS SET: boots Debian's kernel in QEMU (tests/virtual_machine.sh) with a gamepad of uinput that
# GAMEPAD makes, and lets HAPTICS and SET, dance-haptics and dance-haptics-set as they were built here, make it rumble: effects come
# to the device, of the right strength, never early; they keep to the limit, stop when told, and go on when the gamepad is plugged in
# again. What a stand-in for the kernel cannot show. Times are of an emulated processor: they are printed, and not judged; what it makes too
# late, so that the player leaves it out, is ordered again.
set -euo pipefail
gamepad=$(realpath "${1:?give the built virtual_gamepad}")
haptics=$(realpath "${2:?give the built dance-haptics}")
setter=$(realpath "${3:?give the built dance-haptics-set}")
. "$(dirname "$(realpath "$0")")/../../virtual_machine.sh"

machine_begin drivers/input
machine_module evdev
machine_module uinput
machine_run <<END
ip link set lo up; ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo
mount --bind /tmp /host/tmp; chmod 1777 /tmp
bus="udpm://239.255.76.67:7742?ttl=0"
w() { i=0; while ! grep -q "\$1" /tmp/pad; do sleep 0.2; i=\$((i+1)); [ \$i -lt 700 ] || break; done; }
chroot /host $gamepad "\$bus" >/tmp/pad 2>&1 & pad=\$!
w 'plugged in'
echo "== list"; host $haptics list 2>&1
chroot /host $haptics --guest alice --to evdev --limit 0.6 --bus "\$bus" >/tmp/haptics 2>&1 & felt=\$!
w 'wants off'; host $setter --guest alice --off --bus "\$bus"
w 'wants on'; host $setter --guest alice --on --bus "\$bus"
w 'over'; kill \$felt; wait \$felt; echo "ended with \$?"
kill \$pad; wait \$pad
echo "== pad"; cat /tmp/pad
echo "== haptics"; cat /tmp/haptics
END

machine_wants list '^evdev +/dev/input/event[0-9]+  DanceGraph virtual gamepad  16 effects'
# Half of 65535, at most 0.6 of it; never before its time.
machine_wants pad '^played 4[0-9] of [0-9]+, uploads 4[0-9], weak motor 3276[78] to 3276[78], earliest [0-9]'
machine_wants pad '^limited to 0.50 0.10'
for said in '^stopped' '^silent while off' '^is felt again' '^pulled out' '^found again'; do machine_wants pad "$said"; done
machine_wants haptics 'DanceGraph virtual gamepad.* is lost'
machine_wants haptics 'DanceGraph virtual gamepad.* is there, and felt again'
machine_wants haptics 'alice: haptics are off'
machine_wants haptics 'was pulled out 1 times: [0-9]+ played'
machine_wants list '^ended with 0'
exit $machine_failed
