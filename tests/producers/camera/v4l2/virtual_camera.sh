#!/usr/bin/env bash
# virtual_camera.sh PROBE: boots Debian's kernel in QEMU (tests/virtual_machine.sh) with the kernel's own virtual camera (vivid), and
# runs PROBE, as it was built here, against it: it lists the camera, takes pictures in two encodings, is unplugged, and goes on when
# the camera is back. What the preloaded camera cannot show: that a real kernel answers as we think. About a minute.
set -euo pipefail
probe=$(realpath "${1:?give the built camera_probe}")
. "$(dirname "$(realpath "$0")")/../../../virtual_machine.sh"

machine_begin drivers/media drivers/video drivers/usb
machine_module vivid "n_devs=1 node_types=0x1 num_inputs=1 input_types=0 no_error_inj=0"
machine_run <<END
p() { host $probe "\$@"; }
w() { i=0; while ! grep -q "\$1" /tmp/out; do sleep 0.2; i=\$((i+1)); [ \$i -lt 600 ] || break; done; }
echo "== list"; p --list
p --press /dev/video0 "OSD Text Mode" 2
echo "== YUYV"; p 0 5 120 2>&1
echo "== NV12"; p vivid 3 120 1280x720 NV12 2>&1
echo "== unplugged"
p 0 10 300 back 320x180 YUYV >/tmp/out 2>&1 & child=\$!
w 'picture 1'; p --press /dev/video0 Disconnect 1; w gone
rmmod vivid && echo "pulled out" && load vivid && echo "plugged in"
wait \$child; echo "ended with \$?"; cat /tmp/out
END

# The mean of the test picture's eight bars at three quarters: half of 191 in each colour.
bars='blue (9[0-9]|10[0-2]) green (9[0-9]|10[0-2]) red (9[0-9]|10[0-2])$'
machine_wants list '^/dev/video0  vivid  \(platform:vivid-000\)'
machine_wants list '^  YUYV 640x480 .* 25 Hz'
# Larger ones come too slowly to dance by.
machine_wants list '^  taken unless asked otherwise: 640x480 YUYV at 25 Hz'
machine_wants YUYV '^vivid \(/dev/video0\): 640x480 YUYV at 25 Hz'
machine_wants YUYV "^picture 5: 640x480 sequence [0-9]+ $bars"
machine_wants YUYV '^taken 5 .* damaged 0 unplugged 0$'
machine_wants NV12 '^vivid \(/dev/video0\): 1280x720 NV12 at 12.5 Hz'
machine_wants NV12 "^picture 3: 1280x720 sequence [0-9]+ $bars"
for said in '^pulled out' '^plugged in' '^gone' '^back' '^picture 10: 320x180 ' '^taken .* unplugged 1$' '^ended with 0'; do
  machine_wants unplugged "$said"
done
exit $machine_failed
