# Programs as LinuxCNC's interpreter reads them: 500 made of random lines, two fifths of them with something odd, and those that LinuxCNC
# installs. What fettle-mill accepts ends where rs274 does, after the same length and time of feed moves. Reference: rs274,
# which prints four decimals; its tools and G55 have offsets that are not zero.
command -v rs274 > /dev/null || { echo "rs274 (linuxcnc-uspace) is not installed"; exit 77; }
python3 "$HERE/programs.py" --made 500 --seed 1 > made || { cat made; exit 1; }
cat made
awk '$2 == "accepted" { n = $1 } END { exit !(n >= 250) }' made
mapfile -t files < <(find /usr/share/linuxcnc/ncfiles -name '*.ngc' | sort)
python3 "$HERE/programs.py" "${files[@]}" > installed || { cat installed; exit 1; }
cat installed
awk '$2 == "accepted" { n = $1 } END { exit !(n >= 5) }' installed
