#!/usr/bin/env bash
# Tests commands on resources with a real tribodynd: from a data sheet or a table to a curve,
# revisions, export and import, errors, completion, configuration.
# usage: resources_test.sh TRIBODYND TRIBODYN
# shellcheck source=tests/client/support.sh
. "$(dirname "${BASH_SOURCE[0]}")/support.sh"
start_server
here=$PWD
cd "$folder" || exit 1

err_is_empty() { [ ! -s "$folder/err" ] || fail "tribodyn $asked: standard error is not empty"; }

echo "--- from three numbers to a curve"
expect 0 lubricants create my-oil --kv40 73.3 --kv100 8.86 --density15 870
out_has 'viscosity index +92\.4 ' 'SAE J306 grade +80' '[0-9]+ parameters: 3 fitted' \
  'tribodyn lubricants get my-oil' 'tribodyn curve --lubricant my-oil'
expect 0 lubricants get my-oil
out_has 'pressure viscosity coefficient +20\.5[0-9]* +1/GPa +5\.1 +assumed' 'thermal conductivity .* assumed'
err_is_empty
expect 0 curve --lubricant my-oil --first-speed 40 --last-speed 60 --speed-step 10
out_has 'pressure viscosity coefficient 20\.5'
err_is_empty

echo "--- from a table to a curve"
cat >table-oil.csv <<END
temperature_celsius,kinematic_viscosity_square_millimetres_per_second,density_kilograms_per_cubic_metre
0,750,
20,205,
40,73.3,855
100,8.86,
END
expect 0 lubricants import table-oil.csv --base-oil-class group-iii
out_has 'lubricants/table-oil' ' [0-9.]+ %' 'SAE J306 grade +80'
expect 0 lubricants create table-2 --viscosity-table table-oil.csv
expect 1 lubricants import table-oil.csv
err_has 'lubricants/table-oil'
sed 's/205/thick/; s/8.86/x/' table-oil.csv >broken.csv
expect 1 lubricants import broken.csv
err_has 'broken.csv row 3 column kinematic.*thick' 'row 5 column kinematic'

echo "--- units in, units out"
expect 0 lubricants create units --kv40 73.3cSt --kv100 '8.86 mm^2/s' --density15 '0.87 g/cm3' \
  --pressure-viscosity 20/GPa --pressure-viscosity-temperature 40C --thermal-conductivity 0.14W/mK \
  --limiting-shear-stress-at-zero-pressure '4 MPa' --relaxation-time 450ns --brookfield -40=140000 \
  --provenance 'pressure-viscosity=measured:Laboratory X' --uncertainty pressure-viscosity=0.5/GPa
out_has ' 1 measured'
expect 0 lubricants get units
out_has 'pressure viscosity coefficient +20 +1/GPa +0.5 +measured' 'relaxation time +0.45 +us +user' \
  'SAE J306 grade +75W-80'
expect 0 lubricants get units --output json
out_is_json
out_has '"pressure_viscosity_coefficient_per_pascal": 2e-0?8' '"relaxation_time_seconds": 4.5e-0?7'

echo "--- a guest over its quota is served slower"
"$server" tokens create guest --database db.sqlite --calls-per-second 5 >guest.token 2>err
chmod 600 guest.token
pids=()
for i in $(seq 40); do
  TRIBODYN_TOKEN_FILE=guest.token "$client" lubricants get my-oil >"out.$i" 2>&1 &
  pids+=($!)
done
for pid in "${pids[@]}"; do wait "$pid" || fail 'a command of a guest failed'; done

echo "--- errors: all at once, with the nearest name"
expect 2 lubricants create x --kv40 thick --kv100 8,86 --pressure-viscosity 20s --densty15 8
err_has "'thick'" '8\.86$' "'20s'" '--density15'
expect 1 lubricants create x --kv40 0.1 --density15 0.87 --pressure-viscosity 1e6/GPa
err_has '--kv40 = 0.1 mm2/s.* 1 to' '--density15 = 0.87 kg/m3.* 500 to .* 0.87g/cm3 or 870' \
  '--pressure-viscosity 1e6/GPa = '
expect 1 lubricants get my-oill
err_has '"lubricants/my-oil"|"my-oil"'
expect 2 gear-sets import nothing.json
err_has 'nothing.json'

echo "--- revisions"
expect 0 lubricants update my-oil --pressure-viscosity 18/GPa --label project=axle
out_has 'lubricants/my-oil.* 2' 'pressure viscosity coefficient +18 .*user'
expect 0 lubricants revisions my-oil
out_has '^my-oil@2' '^my-oil@1'
expect 0 lubricants get my-oil@1
out_has 'pressure viscosity coefficient +20\.5'
expect 0 diff my-oil@1 my-oil
out_has 'pressure viscosity coefficient +20\.5[0-9]* +18 +1/GPa +-12\.[0-9]+ +assumed / user'
out_lacks 'thermal conductivity'
expect 4 diff my-oil@1 my-oil --exit-code --output csv
out_is_csv
expect 0 diff my-oil my-oil --exit-code
expect 0 diff paper-fluid-1 paper-fluid-2 --all --output json
out_is_json
out_has 'sae_j306_grade'
expect 0 lubricants update my-oil --unset pressure-viscosity-coefficient
out_has 'pressure viscosity coefficient +20\.5.*assumed'
expect 1 lubricants update my-oil --title x --etag stale
err_has 'ABORTED|etag'
expect 0 lubricants list --label project=axle --output csv
out_lines 2
out_has 'pressure_viscosity_coefficient_per_pascal'
expect 0 lubricants list --order-by name --limit 2 --output csv
out_lines 3
token=$(grep -oE -- '--page-token [0-9a-f]+' "$folder/err" | cut -d' ' -f2)
expect 0 lubricants list --order-by name --limit 0 --page-token "$token" --output csv
cp "$folder/out" rest.csv
expect 0 lubricants list --order-by name --output csv
tail -n +4 "$folder/out" | cmp -s - <(tail -n +2 rest.csv) || fail "a page token skips or repeats"
expect 1 lubricants list --page-token nonsense
err_has '--page-token nonsense'
expect 0 lubricants list --filter 'kv100 > 8.8 AND vi > 90 AND name = my-oil AND labels.project:*' --order-by 'kv40 desc'
out_has '^my-oil .* 92\.4 '
expect 1 lubricants list --filter 'kv10 > 8.8'
err_has 'kv100' 'tribodyn help filters'
expect 0 lubricants delete my-oil
expect 0 lubricants list --show-deleted
out_has '^my-oil \(deleted\)'
expect 1 point --lubricant my-oil --speed 50
expect 0 lubricants undelete my-oil
expect 0 lubricants create secret --like my-oil
expect 0 point --lubricant secret --speed 50 --model quasi-static
expect 1 lubricants purge secret
err_has '\b1 .*lubricants/secret'
expect 0 lubricants purge secret --with-jobs --validate-only
out_has 'lubricants/secret: 1 .* 1 '
expect 0 lubricants purge secret --with-jobs
out_has 'lubricants/secret: 1 .* 1 '
expect 1 lubricants purge secret
expect 0 lubricants purge secret --allow-missing

echo "--- files there and back"
for kind in lubricants gear-sets surfaces vehicles; do
  # What came with the server states its provenance with its first import; from then on nothing
  # changes.
  expect 0 "$kind" export --all --file first.json
  expect 0 "$kind" import first.json --replace
  expect 0 "$kind" export --all --file "$kind.json"
  expect 0 "$kind" import "$kind.json" --replace
  expect 0 "$kind" export --all --file again.json
  cmp -s "$kind.json" again.json || fail "$kind: export, import, export is not identical"
done
expect 0 validate {lubricants,gear-sets,surfaces,vehicles}.json
expect 0 lubricants export units --file units.json
sed 's,lubricants/units,lubricants/units-2,' units.json >units-2.json
expect 0 lubricants import units-2.json
expect 0 diff units units-2 --exit-code
printf '{"lubricants": [{"name": "lubricants/half", "measurements": {
  "kinematic_viscosity_40_celsius_square_millimetres_per_second": 73}},
  {"name": "lubricants/other", "relaxation_time_seconds": -1}]}' >half.json
expect 1 lubricants import half.json
err_has 'lubricants\[1\]'
expect 1 lubricants get half
printf '{"name": "lubricants/q", "measurments": {}}' >misspelt.json
expect 2 validate misspelt.json
err_has 'measurements'
expect 1 validate half.json units.json
out_has 'units.json'
fluid='"measurements": {"kinematic_viscosity_40_celsius_square_millimetres_per_second": 73,
  "kinematic_viscosity_100_celsius_square_millimetres_per_second": 9,
  "density_15_celsius_kilograms_per_cubic_metre": 870}'
printf '{"lubricants": [{"name": "lubricants/drained", "derived_from": "lubricants/filled", %s},
  {"name": "lubricants/filled", %s}]}' "$fluid" "$fluid" >derived.json
expect 0 lubricants import derived.json
expect 0 lubricants get drained
out_has '[^/]lubricants/filled'
printf '{"lubricants": [{"name": "lubricants/twice", %s}, {"name": "lubricants/twice", %s}]}' \
  "$fluid" "$fluid" >twice.json
expect 2 lubricants import twice.json
err_has 'lubricants\[0\] .*lubricants\[1\]'

echo "--- validation of a simulation"
expect 0 curve --lubricant paper-fluid-1 --lubricant my-oil --label checked=yes --validate-only
out_has 'lubricants/my-oil .*[0-9a-f]{64}$'
expect 0 jobs list --label checked=yes --output csv
out_lines 0

echo "--- one fluid per row"
cat >rows.csv <<'END'
name;kinematic_viscosity_40_celsius_square_millimetres_per_second;kinematic_viscosity_100_celsius_square_millimetres_per_second;base_oil_class;condition;derived_from;labels.project;display_name;flash_point_celsius
row-used;70;8.6;pao;used;row-fresh;axle;;
row-fresh;73.3;8.86;pao;fresh;;axle;"An ""oil""; fresh";212
END
expect 0 lubricants import rows.csv
expect 0 lubricants get row-used
out_has 'lubricants/row-fresh'
out_lacks 'flash point'
expect 0 lubricants export row-fresh row-used --output csv --file rows-2.csv
err_is_empty
grep -q ',212' rows-2.csv || fail "the table lacks the flash point"
expect 0 lubricants import rows-2.csv --replace
expect 0 lubricants export row-fresh row-used --output csv --file rows-3.csv
cmp -s rows-2.csv rows-3.csv || fail "rows: export, import, export is not identical"
sed -e 's/;73.3;/;thick;/; s/;used;/;usd;/; s/display_name/display_nme/' rows.csv >rows-bad.csv
expect 2 lubricants import rows-bad.csv --replace
err_has "row 2 column condition: 'usd'" "row 3 column kinematic_viscosity_40.*: 'thick'" 'display_name'
sed -e 's/;73.3;/;1e9;/; s/;8.6;/;-1;/' rows.csv >rows-bad.csv
expect 1 lubricants import rows-bad.csv --replace
err_has 'row 2 column kinematic_viscosity_100_.* = -1 mm2/s' 'row 3 column kinematic_viscosity_40_.* = 1000000000 mm2/s'
expect 1 lubricants import rows.csv
err_has 'row 2 column name: lubricants/row-used' '--replace'
expect 0 lubricants export --all --output csv --file all.csv
expect 0 lubricants import all.csv --replace
for fluid in table-oil row-used; do # an import of what is there makes no revision
  expect 0 lubricants revisions "$fluid" --output csv
  out_lines 2
done
printf '{"lubricants": []}' >none.json
expect 0 lubricants import none.json

echo "--- tables as spreadsheets write them"
printf 'Name;KV40;kv100;Density15;Base oil class;display_name\n;mm2/s;mm2/s;g/cm3;;\nexcel;73,3;8,86;0,87;Gr. III;\326l\n' >excel.txt
expect 0 lubricants import excel.txt
err_has '^.*3 cells' 'Latin-1'
out_has 'excel: .+l' 'density at 15 C +870 '
printf 'PK\003\004rest' >book.csv
expect 2 lubricants import book.csv
expect 2 lubricants create book --viscosity-table book.csv
err_has 'book.csv'
printf 'name,kv40,kv100,base_oil_class\ntwin,73.3,8.86,pao\nother,0.00007,8,pao\ntwin,73.3,8.86,pao\n' >twins.csv
expect 2 lubricants import twins.csv
err_has 'lubricants/twin .*row 2 .*row 4' 'row 3 column kv40: .* 70 mm2/s'

echo "--- a table that starts from a lubricant, or a surface"
expect 0 lubricants create based --kv40 103 --kv100 15 --density15 868 --base-oil-class ester \
  --pressure-viscosity 20/GPa --provenance pressure-viscosity=measured:Mine
printf 'name,kv40,pressure_viscosity_coefficient_per_pascal,labels.doe\nvar-1,,1.8e-8,1\nvar-2,110,,2\n' >var.csv
expect 0 lubricants import var.csv --like based
expect 0 lubricants get var-1
out_has 'KV40 +103 ' 'pressure viscosity coefficient +18 .*user'
expect 0 lubricants get var-2
out_has 'KV40 +110 ' 'base oil +ester' 'pressure viscosity coefficient +20 .*measured'
expect 0 lubricants import table-oil.csv --id based-table --like based
expect 0 lubricants get based-table
out_has 'KV40 +73\.3 ' 'density at 15 C +87[0-9]' 'pressure viscosity coefficient +20 .*measured' 'base oil +ester'
printf 'name,composite_rms_height_metres\nvar-a,3e-7\nvar-b,\n' >varsurf.csv
expect 0 surfaces import varsurf.csv --like run-in
expect 0 surfaces export var-a var-b --output csv
out_has '^surfaces/var-a,.*3e-0?7' '^surfaces/var-b,'
expect 2 lubricants import units.json --like based
err_has '--like'

echo "--- export to a spreadsheet and import"
expect 0 lubricants create cold --kv40 103 --kv100 15.1 --density15 868 --brookfield -40=98Pas \
  --kv100-sheared 14.2 --base-oil-class pao --density 100=815 --viscosity 20=283mm2/s \
  --thermal-conductivity 0.14W/mK --provenance 'thermal-conductivity=measured:Laboratory X' \
  --uncertainty thermal-conductivity=0.01W/mK --label 'project=axle, rear'
oils=(paper-fluid-1 paper-fluid-2 paper-fluid-3 shell-t9 excel cold my-oil)
without_dates() { grep -vE '"(name|etag|revision|create_time|revision_create_time)"' "$1"; }
expect 0 lubricants export "${oils[@]}" --output csv --file there.csv
err_is_empty
sed '2,$s,^lubricants/,lubricants/back-,' there.csv >back.csv
expect 0 lubricants import back.csv
expect 0 lubricants export "${oils[@]}" --file there.json
expect 0 lubricants export "${oils[@]/#/back-}" --file back.json
cmp -s <(without_dates there.json) <(without_dates back.json) || fail "an oil changes with export and import"
expect 0 lubricants get back-cold
out_has 'SAE J306 grade +75W-90'
expect 0 lubricants export cold --output csv --file cold.csv
sed '2s/,103,/,110,/' cold.csv >cold-2.csv
expect 0 lubricants import cold-2.csv --replace
expect 0 lubricants get cold
out_has 'KV40 +110 ' 'thermal conductivity +0.14 .*0.01 +measured'
expect 0 lubricants export cold --viscosity-table cold-table.csv
grep -q '^-40,,98000,' cold-table.csv || fail "the table of viscosities lacks a cold one"

echo "--- slips of a data sheet"
expect 1 lubricants create slip --kv40 103 --kv100 15 --density15 868 --brookfield -40=150 \
  --base-oil-class pao
err_has '150000'
expect 1 lubricants create slip --kv40 103 --kv100 15 --uncertainty pressure-viscosity=1/GPa
err_has 'pressure_viscosity_coefficient_per_pascal'
expect 2 lubricants create latin --kv40 73.3 --kv100 8.86 --title "$(printf '\351l')"
err_has 'UTF-8'
expect 0 lubricants delete row-fresh
expect 0 lubricants export --all --file all.json
grep -q 'lubricants/row-fresh"' all.json || fail "an export lacks the deleted parent of a fluid"

echo "--- tables of gear sets and surfaces"
expect 0 gear-sets export reference-axle --tooth-contact contact.csv --series series.csv
expect 0 gear-sets import contact.csv --series series.csv --id table --like reference-axle
expect 0 gear-sets export table --tooth-contact contact-2.csv --series series-2.csv
cmp -s contact.csv contact-2.csv || fail "tooth contact: export, import, export is not identical"
cmp -s series.csv series-2.csv || fail "series: export, import, export is not identical"
awk -F, -v OFS=, 'NR == 5 { $3 = 7 } { print }' contact.csv >bent.csv
expect 1 gear-sets create bent --like reference-axle --tooth-contact bent.csv --gear-teeth 37
err_has 'row 5 column load_share' 'R_g0'
awk 'BEGIN { print "position_micrometres,height_nanometres"
  for (i = 0; i < 300; i++) print i * 0.5 "," 300 * sin(i / 7) + 40 * sin(i * i) }' >profile.csv
expect 0 surfaces create rough --like run-in --profile pinion,axial,profile.csv \
  --profile gear,radial,profile.csv
out_has '^pinion +axial +300' 'composite rms height .* fitted' '^ *! .* [0-9.]+'
expect 0 surfaces create filtered --like run-in --profile profile.csv --lambda-s 2.5um
out_has '^both flanks +- +300 +0.5 +2.5 +- '
expect 1 surfaces create waved --like run-in --profile profile.csv --lambda-c 3
err_has 'lambda_c = 0.003 m'
expect 0 surfaces create joined --like run-in --profile axial,profile.csv \
  --profile radial,profile.csv --as-published eq46
out_has 'eq 46'
expect 1 surfaces create one --like run-in --profile profile.csv --as-published eq46
err_has 'eq 46'
expect 2 surfaces create none --like run-in --as-published eq46
err_has '--as-published'
expect 0 validate contact.csv profile.csv table-oil.csv
expect 0 vehicles create van --like passenger-car --mass '2.1 t' --wheel-radius 0.35
out_has 'mass +2100 +kg .*user' 'vehicles/passenger-car@[0-9]'

echo "--- schema and help"
expect 0 schema lubricants
out_has 'thermal_conductivity_watts_per_metre_kelvin +0.001 +100 +W/\(m K\) +eq 35'
expect 0 schema --output csv
out_has '^Surface,asperity_radius_metres,'
expect 1 schema lubrcant
err_has '"Lubricant"'
expect 0 lubricants create --help-all
out_has ' 0.1 to( 1000 1/GPa)?' '1/GPa \(eq 33'
TRIBODYN_SERVER=127.0.0.1:9 expect 0 lubricants create --help
expect 0 help lubricants create
out_has '--kv40'
expect 0 help units
out_has 'GPa'
expect 2 help unitz
err_has 'units'

echo "--- configuration: flag, environment, file"
mkdir -p "$XDG_CONFIG_HOME/tribodyn"
printf '# mine\noutput = csv\nserver = 127.0.0.1:9\n' >"$XDG_CONFIG_HOME/tribodyn/config"
expect 0 vehicles list
out_is_csv
TRIBODYN_OUTPUT=json expect 0 vehicles list
out_is_json
TRIBODYN_OUTPUT=json expect 0 vehicles list -o table
out_has '^passenger-car'
out_lacks $'\x1b' # not a terminal
address=$TRIBODYN_SERVER
unset TRIBODYN_SERVER
expect 3 vehicles list
export TRIBODYN_SERVER=$address
printf 'outptu = csv\n' >"$XDG_CONFIG_HOME/tribodyn/config"
expect 2 vehicles list
err_has 'output' 'tribodyn help configuration'
rm "$XDG_CONFIG_HOME/tribodyn/config"
TRIBODYN_CONFIG=/nonexistent expect 2 vehicles list

echo "--- colours only on terminals"
expect 0 lubricants get my-oil --color always
grep -q $'\x1b' out || fail "no colours with --color always"
if command -v script >/dev/null; then
  on_terminal() { TERM=xterm script -qec "$*" /dev/null </dev/null >"$folder/terminal"; }
  on_terminal "'$client' lubricants get my-oil"
  grep -q $'\x1b' terminal || fail "no colours on a terminal"
  on_terminal "NO_COLOR=1 '$client' lubricants get my-oil"
  ! grep -q $'\x1b' terminal || fail "colours with NO_COLOR"
  on_terminal "'$client' lubricants get my-oil --no-color"
  ! grep -q $'\x1b' terminal || fail "colours with --no-color"
  on_terminal "'$client' curve -l paper-fluid-1 --first-speed 50 --last-speed 60 --speed-step 5"
  grep -q '\] *[0-9]* %' terminal || fail "no progress on a terminal"
fi

echo "--- bash completion"
expect 0 completion zsh
if command -v zsh >/dev/null; then zsh -n "$folder/out" || fail "zsh cannot read its script"; fi
expect 0 completion bash
completed() {
  PATH="$(dirname "$client"):$PATH" bash -c '
    . "$1"; COMP_LINE=$2; COMP_POINT=${#2}; _tribodyn 2>/dev/null; printf "%s " "${COMPREPLY[@]}"' \
    bash "$folder/out" "$1"
}
[ "$(completed 'tribodyn lubricants get my')" = 'my-oil ' ] || fail "completion of a name"
[ "$(completed 'tribodyn curve --lubricant paper-fluid-1,my')" = 'paper-fluid-1,my-oil ' ] || fail "completion of a second name"
[ "$(completed 'tribodyn curve --surface=run')" = 'run-in ' ] || fail "completion after ="
[ "$(completed 'tribodyn validate units-')" = 'units-2.json ' ] || fail "completion of a file"

echo "--- a batch whose full answer would be too large is written all the same"
text=$(printf 'd%.0s' {1..3900})
numbers='"measurements": {"kinematic_viscosity_40_celsius_square_millimetres_per_second": 73,
  "kinematic_viscosity_100_celsius_square_millimetres_per_second": 9}'
{
  printf '{"lubricants": ['
  for i in {1..1100}; do
    [ "$i" -eq 1 ] || printf ','
    printf '{"name": "lubricants/many-%s", "description": "%s", %s}' "$i" "$text" "$numbers"
  done
  printf ']}'
} >many.json
expect 0 lubricants import many.json --output csv
out_lines 1101
expect 0 lubricants import many.json --replace --validate-only
expect 1 lubricants import many.json --replace --validate-only --output json
err_has ' 1100 .*--output'

echo "--- numbers that the model does not use"
expect 0 lubricants create data-sheet --like paper-fluid-1 --flash-point 212C --pour-point 0
out_has 'flash point +212 C' 'pour point +0 C'
expect 0 lubricants export data-sheet --output csv --file data-sheet.csv
grep -q 'flash_point_celsius,pour_point_celsius' data-sheet.csv || fail "the table lacks the flash point"
! grep -q 'flash_point_celsius[.]source' data-sheet.csv || fail "the flash point has a source"
expect 0 lubricants import data-sheet.csv --replace
expect 0 lubricants revisions data-sheet --output csv
out_lines 2
expect 0 lubricants update data-sheet --unset flash-point
out_lacks 'flash point'
expect 2 lubricants update data-sheet --provenance pour-point=measured
err_has "'pour-point'"
expect 1 lubricants update data-sheet --pour-point -200
err_has '--pour-point = -200 C.* -120 to 100 C .ASTM D97.'
expect 0 lubricants list --filter 'pour_point_celsius <= 0' --output csv
out_lines 2

echo "--- boundary friction by temperature"
expect 0 lubricants create projects/default/lubricants/by-temperature --like paper-fluid-1 \
  --asperity-friction-by-temperature 40=0.12 --asperity-friction-by-temperature 100=0.08
expect 4 diff paper-fluid-1 by-temperature --exit-code
out_has 'at 40 C +- +0\.12' 'at 100 C +- +0\.08'
expect 2 lubricants export paper-fluid-1 by-temperature --output csv --file by-temperature.csv
err_has 'by-temperature.* JSON'
[ ! -e by-temperature.csv ] || fail 'a table without the boundary friction was written'
expect 1 compare 75W/90 paper-fluid-1
! grep -q 'did you mean' "$folder/err" || fail 'a name that resembles none is suggested'
cd "$here" || exit 1

finish
