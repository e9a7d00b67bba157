#!/usr/bin/env bash
# Drives every command of the command line against a real tribodynd: a free port on loopback, a
# database in a temporary folder.
# usage: command_line_test.sh TRIBODYND TRIBODYN
# shellcheck source=tests/client/support.sh
. "$(dirname "${BASH_SOURCE[0]}")/support.sh"

# pictures FILE.svg...: whole pictures without numbers that are none.
pictures() {
  for picture; do
    grep -q '</svg>' "$folder/$picture" || fail "tribodyn $asked: $picture is not whole"
    ! grep -qw nan "$folder/$picture" || fail "tribodyn $asked: nan in $picture"
  done
}
# The number of the first campaign on standard output.
campaign_of_output() { grep -oE 'campaigns/[0-9]+' "$folder/out" | head -n 1 | grep -oE '[0-9]+$'; }
# in_background PATTERN COMMAND...: starts it, waits until standard error has the pattern.
in_background() {
  local pattern=$1
  shift
  asked="$*, then Ctrl-C"
  "$client" "$@" --progress lines >"$folder/out" 2>"$folder/err" </dev/null &
  client_pid=$!
  until grep -q "$pattern" "$folder/err" || ! kill -0 "$client_pid" 2>/dev/null; do sleep 0.02; done
}
# interrupt: sends Ctrl-C to the client in the background.
interrupt() {
  local code=0
  kill -INT "$client_pid"
  wait "$client_pid" || code=$?
  [ "$code" -eq 130 ] || fail "$asked: exit code $code, not 130"
}

echo "--- without a server"
TRIBODYN_SERVER=127.0.0.1:9 expect 3 lubricants list
err_has '127.0.0.1:9'
expect 3 --server "unix:$folder/none" lubricants list
expect 0 --help
out_has '^ +curve '
expect 0 --version
out_has '[0-9]\.[0-9]'
expect 2

start_server

echo "--- errors: all at once, by the names that were typed"
expect 0 curve --help
out_has '--help-all' '^  --lubricant'
expect 0 curve --help-all
out_has '^  --server <HOST:PORT>$' '^  --as-published'
expect 2 point --speed fast --sump hot --model quick --nonsense
err_has "'fast'" "'hot'" "'quick'" --nonsense '--lubricant'
expect 1 point --lubricant paper-fluid-7 --speed -5 --sump-temperature-celsius 900 \
  --march-step-tolerance 1 --gear-set Z
err_has '--speed = -5 km/h.* 0\.1 to 400' '--sump-temperature-celsius = 900 C.* -70 to 200' \
  '--march-step-tolerance = 1' 'lubricants/paper-fluid-7' 'gearSets/Z'
expect 1 history --lubricant paper-fluid-1 --speed 50 --columns mesh_force_newton,nothing --samples-per-mesh-cycle 1
err_has 'mesh_force_newtons' '--columns' '--samples-per-mesh-cycle = 1'
expect 1 curve --lubricant paper-fluid-1,paper-fluid-8 --first-speed 90 --last-speed 20
err_has 'lubricants/paper-fluid-8' '--last-speed = 20'
expect 1 jobs watch none

echo "--- lubricants"
expect 0 lubricants list
out_has '^paper-fluid-1 ' '^paper-fluid-3 ' '^shell-t9 '
expect 0 lubricants list --output json
out_is_json
out_has '"lubricants": \[' '"pressure_viscosity_coefficient_per_pascal": 1.931e-0?8'
expect 0 lubricants get lubricants/paper-fluid-2 -o csv
out_lines 2

echo "--- from data sheets to a decision in three commands"
cat >"$folder/oils.csv" <<'SHEETS'
name,base oil,KV40 (mm2/s),KV100 (mm2/s),KV100 after shear (mm2/s),density 15 C (g/cm3)
75W-90,PAO,103,15.1,14.2,0.868
75W-85,PAO,66.5,11.4,10.9,0.857
75W-80,Gr. III,52.4,9.1,,0.851
75W-90-ester,Ester,98,15.6,15.3,0.921
80W-90,Gr. I,138,14.3,,0.892
sheet-a,PAO,103,15.1,,0.868
sheet-b,PAO,100,14.9,,0.866
SHEETS
expect 0 lubricants import "$folder/oils.csv"
out_has '  tribodyn compare 75W-90 75W-85 75W-80 75W-90-ester 80W-90 sheet-a sheet-b --speed 30,60,90,120$'
expect 0 compare 75W-90 75W-85 75W-80 75W-90-ester 80W-90 --speed 60 --sump 80
out_has '^ +1 +75W-90@1 +[0-9.]+ ' \
  '^ +5 +75W-80@1 +[0-9.]+ +[0-9.]+ to [0-9.]+ +[<0-9 ]+ % +[0-9.]+ +-?[0-9.]+ to [0-9.]+ ' \
  '^  tribodyn explain 75W-90@1 75W-80@1 --speed 60 --sump 80$' \
  '^  tribodyn report 75W-90 75W-85 75W-80 75W-90-ester 80W-90 --sump 80 --html report.html$'
explain=$(grep -oE 'explain 75W-90@1 75W-80@1 .*' "$folder/out")
# shellcheck disable=SC2086
expect 0 $explain --draws 19 --plot "$folder/why.svg"
out_has '^ *75W-80@1 ' '^difference +[0-9.]+ .* 100 '
pictures why.svg
printf 'name,kv40\n75W-90 new,100\n' >"$folder/blank.csv"
expect 1 lubricants import "$folder/blank.csv"
err_has '"75W-90-new"'
# A slash cuts nothing off a name.
expect 1 lubricants create 75W/90 --kv40 100 --kv100 14 --density15 868
err_has '75W-90'
printf 'name,kv40,kv100\nBrandA/9876543,100,14\n' >"$folder/slash.csv"
expect 1 lubricants import "$folder/slash.csv"
err_has 'BrandA-9876543'
expect 1 lubricants import "$folder/slash.csv" --replace
err_has 'BrandA-9876543'

echo "--- contact, rigs, viscosities, spectra"
expect 0 contact --lubricant 75W-90
out_has ' h_cen +[0-9.]+ ' ' V_s/\|U_p\| +[0-9.]+' ' mu +0\.[0-9]+ +0\.[0-9]+'
expect 0 contact --lubricant 75W-90 --newtonian --output csv
out_is_csv
out_lines 2
out_has ',friction_coefficient_standard_uncertainty'
expect 0 contact --output json
out_is_json
out_has '"central_film_thickness_metres": [0-9.]+e-0?[67]'
expect 0 traction paper-fluid-1 sheet-a --radius 12.7mm --load 38,154 --isothermal --draws 49 --plot "$folder/bands.svg"
out_has '^paper-fluid-1@1 +thermal +38 +2 +0 +40 +0 ' '^sheet-a@1 +isothermal +154 +2 +50 +40 +0\.0[0-9]+ +0\.[0-9]+ '
pictures bands.svg
grep -q 'fill-opacity' "$folder/bands.svg" || fail "traction draws no bands"
expect 0 film sheet-a --speed 0.1,1 --output csv
out_is_csv
out_lines 3
out_has '^lubricant,model,load_newtons,entrainment_speed_metres_per_second' ',central_film_thickness_metres_standard_uncertainty,'
printf 'entrainment_speed_metres_per_second,traction_coefficient,load_newtons\n0.01,0.1,20\n1,0.04,20\n' >"$folder/rig.csv"
expect 0 stribeck paper-fluid-1 --measured "$folder/rig.csv" --load 20 --plot "$folder/stribeck.svg"
out_has 'paper-fluid-1@1: .* [0-9.]+ % of 2 '
pictures stribeck.svg
expect 0 stribeck sheet-a --draws 0 --output json
out_is_json
out_lacks 'interval'
expect 0 traction paper-fluid-1 paper-fluid-2 --map slide-roll-ratio,pressure --plot "$folder/map.svg"
out_has '^paper-fluid-1@1: ' '^1\.5 +0 '
pictures map.svg
expect 0 film paper-fluid-1 --map temperature,speed --temperature 40,60,90 --speed 0.1,1 --output csv
out_lines 7
expect 0 traction paper-fluid-1 --pressure 0.8GPa --srr 10 --output csv
out_lines 2
expect 0 viscosity paper-fluid-1 shell-t9 --plot "$folder/viscosity.svg"
out_has '^ *40 +818\.1 +[0-9.]+ +[0-9.]+ +16\.09 '
pictures viscosity.svg
expect 0 viscosity paper-fluid-1 --temperature 40,100 --pressure 0,1GPa --output csv
out_is_csv
out_lines 5
expect 0 viscosity paper-fluid-1 --output json
out_is_json
expect 0 spectrum --lubricant paper-fluid-1 --speed 65 --plot "$folder/spectrum.svg"
out_has ' [0-9.]+ Hz' ' 192'
pictures spectrum.svg
expect 0 spectrum --lubricant paper-fluid-1 --speed 65 --maximum-order 4 --output csv
out_is_csv
out_lines 5
out_has '^order,amplitude_dynamic_transmission_error_metres,phase_angle_radians_dynamic_transmission_error_metres,'

echo "--- drive cycles"
printf 'time_seconds,speed_kilometres_per_hour,ascent_angle_degrees\n0,0,0\n5,30,2\n20,30,-1\n25,0,0\n' >"$folder/own.csv"
expect 0 cycle paper-fluid-1 paper-fluid-2 --cycle "$folder/own.csv" --plot "$folder/cycle.svg" --csv "$folder/pieces.csv"
out_has '^all +25 +0\.167 ' '^paper-fluid-2@1: .* [0-9.]+ kJ'
pictures cycle.svg
[ "$(wc -l <"$folder/pieces.csv")" -eq 26 ] || fail "tribodyn cycle: pieces.csv"
expect 0 cycle paper-fluid-1 --cycle "$folder/own.csv" --output json
out_is_json
expect 0 cycle paper-fluid-1 --cycle "$folder/own.csv" --point-by-point --output csv
out_has '^all,'
printf 'time_seconds,speed_kilometres_per_hour,sump_temperature_celsius\n0,60,40\n60,60,90\n' >"$folder/own.csv"
expect 0 cycle paper-fluid-1 --cycle "$folder/own.csv"
out_has '40\.42 to 89\.58 C'
printf 'time_seconds,speed_kilometres_per_hour\n0,0\n5,x\n' >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 --cycle "$folder/bad.csv"
err_has "bad.csv, line 3, speed_kilometres_per_hour: 'x'"
printf '# own\n\ntime_seconds,speed_kilometres_per_hour\n0,0\n5,20\n5,300\n5.5,10\n' >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 paper-fluid-11 --cycle "$folder/bad.csv"
err_has '"lubricants/paper-fluid-1"' 'bad.csv, line 6, time_seconds: time_seconds = 5 s' \
  'bad.csv, line 7, speed_kilometres_per_hour: .* -161.1 m/s2.* -50 to 50 m/s2'
{ echo time_seconds,speed_kilometres_per_hour; seq 1000000 | sed 's/$/,50/'; } >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 --cycle "$folder/bad.csv"
err_has 'bad.csv .* 1000000 .* 10000'
expect 1 cycle paper-fluid-1 --cycle "$folder/own.csv" --point-by-point --map-tolerance 1e-3
err_has 'map-tolerance = 0.001'

# Measured profiles: six are one surface, whose parameters move with the sampling interval.
for place in heel middle toe; do
  awk -v place="$place" 'BEGIN { srand(length(place)); z = 0; print "position_micrometres,height_nanometres"
    for (i = 0; i < 1000; ++i) { print i "," z; z = 0.99 * z + 60 * (rand() - 0.5) } }' >"$folder/$place.csv"
done
expect 0 roughness {pinion,gear},axial,"$folder"/{heel,middle,toe}.csv --plot "$folder/roughness.svg"
out_has '^pinion, axial +3 ' '^ +16 +16 .* ± '
pictures roughness.svg
expect 0 roughness pinion,axial,"$folder/heel.csv" --sampling-steps 1,5 --output csv
out_is_csv
out_lines 3
out_has '^sampling_step,spacing_metres,asperity_density_per_square_metre,.*,roughness_product,standard_uncertainty_'
expect 0 roughness "$folder/heel.csv" --lambda-s 5 --output json
out_is_json
printf 'position_micrometres,height_nanometres\n0,1\n1,x\n2,1\n' >"$folder/bad.csv"
expect 1 roughness "$folder/bad.csv"
err_has 'bad.csv row 3 column height_nanometres'
expect 1 roughness "$folder/heel.csv" --sampling-steps 1,500
err_has '1 to 200'

# Figures of the paper, by their numbers.
expect 0 paper 10 --output "$folder/paper"
out_has '\b10\b'
for file in index.html figure-10.svg figure-10.csv findings.csv; do
  [ -s "$folder/paper/$file" ] || fail "tribodyn paper 10: no $file"
done
expect 0 paper 9 14 --output csv
out_has '^figure,statement,verdict,quantity,unit,at,value$' '^14,'
expect 0 paper 9 -o json
out_is_json
expect 1 paper 9 --output "$folder/no/such"

echo "--- point"
expect 0 point --lubricant 75W-90 --speed 72.5 --condition sheared --solver-details --assumptions --progress lines
out_has ' %, (\+/- [0-9.]+|[0-9.]+ to [0-9.]+)$' ' solver error 0\.[0-9]+; ' ' [0-9.]+ W' '[0-9a-f]{64}' ' 0\.940' 'asperity_radius_metres'
err_has '^lubricants/75W-90: '
expect 0 point --lubricant paper-fluid-1 --speed 50 --model quasi-static --isothermal --output csv
out_lines 2
out_has ',mesh_loss_power_watts,'
expect 0 point --lubricant paper-fluid-1 --speed 50 --model automatic --output json
out_is_json
out_has '"inefficiency_energy_mean_percent": [0-9]' '"model": ".*FULL"'
expect 0 point --lubricant paper-fluid-1 --speed 50 --pressure-limit 1.8GPa --flash-temperature-limit 5 \
  --limit-source 'FZG A/8.3/90'
out_has ' [0-9.]+ +>= 1 ' 'GPa +0\.[0-9]+ +<= 1\.8 +yes .*FZG A/8\.3/90' ' K +[0-9.]+ +<= 5 +no .*FZG'
# A torque far beyond the data of the gear set stands first.
expect 0 point --lubricant paper-fluid-1 --model quasi-static --torque 765 --pinion-speed 200rad/s
head -1 "$folder/out" | grep -q '^! .* 765 N m.* 7.[67] ' || fail "no word of the torque at the top"
expect 0 point --lubricant paper-fluid-1 --model quasi-static --speed 50 --acceleration 0.5 --ascent -1
out_has ' 50 km/h .*0\.5 m/s2, .*-1 degrees'
expect 1 point --lubricant sheet-a --speed 60 --condition sheared
err_has '--condition'

echo "--- comparison, explanation, report"
expect 0 compare sheet-a sheet-b --speed 40,60 --sumps 40,90 --weights 2,1 --sump-weights 1,3 --draws 19 \
  --plot "$folder/compared.svg"
out_has '^ +60 +90 ' 'tribodyn explain sheet-.@1 sheet-.@1 --speed 40,60 --weights 6,3 --sump 90$'
pictures compared.svg
expect 0 compare sheet-a --speed 60 --output csv
out_lines 2
out_has ',inefficiency_energy_mean_percent_standard_uncertainty,'
expect 0 compare sheet-a sheet-b --speed 60 --draws 19 --output json
out_is_json
out_has '"verdict": "CANNOT_BE_TOLD_APART"' '"not_included": ".+"' '"deciding_inputs"'
# Without heating of the inlet there is no verdict on cold oils.
expect 0 compare sheet-a paper-fluid-1 --speed 60 --sump=-10 --draws 19 --inlet-shear-heating=false --output csv
out_has ',warnings,.*difference\.verdict,' ',[A-Z_ ]*INLET_HEATING_LEFT_OUT[A-Z_ ]*,(.*,)?WITHHELD,'
expect 0 explain sheet-a sheet-b --speed 40 --draws 19 --output csv
out_lines 13
out_has '^lubricants/sheet-a@1,lubricants/sheet-b@1,one,40,'
expect 0 explain 75W-90 75W-90 --other-condition sheared --draws 19 --output json
out_is_json
expect 0 help models
grep -q '@' "$folder/out" && fail 'help models has a number to fill in'
words=$(sed -nE 's/^  ([a-z-]+) +[-+][0-9.]+ .*/\1/p' "$folder/out" | paste -s -d , -)
[ -n "$words" ] || fail 'help models states no changes'
expect 0 curve --lubricant paper-fluid-1 --speeds 60 --compare "$words"
expect 0 schema
out_has '^mesh_loss_power_watts +W ' '^flank_sliding_speed_metres_per_second +m/s ' '^flank_losses_0_friction_coefficient +'
expect 0 report sheet-a sheet-b --speeds 40,100 --html "$folder/report.html"
out_has 'report\.html'
for part in '<svg' 'tribodyn report sheet-a@1 sheet-b@1 --speeds 40,100'; do
  grep -qF -- "$part" "$folder/report.html" || fail "the report has no '$part'"
done
grep -Eq 'https?://[^w]' "$folder/report.html" && fail 'the report refers to another place'
expect 0 report paper-fluid-1 --speeds 40 --html "$folder/alone.html"

echo "--- screening"
table=$folder/candidates.csv
printf '%s\n' 'name;treat rate;pressure-viscosity (1/GPa);asperity friction coefficient' \
  'good;0,5;15,5;0,09' 'bad;1;19;0,12' 'like the base;0;;' 'slip;2;16e-9;' >"$table"
expect 0 screen "$table" --like paper-fluid-1 --speeds 20,60 --sumps 40,90 --weights 1,3
out_has '^ *1  good +[0-9.]+ +[0-9.]+ +-[0-9.]+' '^ *3  like the base +[0-9.]+ +[0-9.]+ +0\.00 ' \
  'slip: pressure-viscosity \(1/GPa\) = 1.6e-17 1/Pa'
err_has '^.*[0-9] cells'
expect 0 screen "$table" --like paper-fluid-1 --output csv
out_lines 5
out_has '^1,good,0\.5,15\.5,0\.09,[0-9.]+,'
expect 0 screen "$table" --like paper-fluid-1 --uncertainty pressure-viscosity=30% --pareto 'treat rate' \
  --plot "$folder/screen.svg"
out_has '^ *2  like the base .* [0-9]+ %'
pictures screen.svg
expect 0 screen "$table" --like paper-fluid-1 --pareto 'treat rate' --output json
out_is_json
expect 2 screen "$table" --like paper-fluid-1 --pareto 'treat rat'
err_has '--pareto' 'treat rate'
expect 0 design --range pressure-viscosity=14/GPa:18/GPa --range asperity-friction-coefficient=0.05:0.12 --count 16
out_lines 17
cp "$folder/out" "$table.design"
expect 0 screen "$table.design" --like paper-fluid-1 --effects
out_has '^pressure_viscosity_coefficient_per_pascal +1\.'
printf '%s\n' name,kv40,kv100 A,103,15 >"$table"
expect 2 screen "$table" --like sheet-a
err_has 'lubricants import' 'pressure viscosity coefficient'
expect 0 design --uncertainties-of sheet-a --count 4 --method latin-hypercube
out_has '^candidate,pressure_viscosity_coefficient_per_pascal,'
printf '%s\n' name,kv40,kv100 A,73.3,8.86 B,9,73 >"$table"
expect 0 screen "$table" --like paper-fluid-1
out_has '^ *1  A  ' '^.*B: .*73 mm2/s'
expect 1 screen "$table" --like no-such-oil --speeds 900
err_has '--speeds = 900 km/h' '"lubricants/no-such-oil"'
{
  echo relaxation_time_seconds,cost
  seq 400 | sed 's/.*/&e-9,&/'
} >"$table"
expect 0 screen "$table" --like paper-fluid-1 --speeds 20,60 --csv "$folder/whole.csv"
campaign=$(campaign_of_output)
# The same call finds its campaign; a pipe gets JSON lines as a file does.
"$client" screen "$table" --like paper-fluid-1 --speeds 20,60 --jsonl /dev/fd/3 3>&1 >"$folder/out" 2>&1 |
  cat >"$folder/points.jsonl"
[ "$(wc -l <"$folder/points.jsonl")" -eq 800 ] || fail 'JSON lines are missing'
[ "$(campaign_of_output)" = "$campaign" ] || fail 'the same screening has another campaign'
sed 's/cost/cost_of_drum/' "$table" >"$folder/renamed.csv"
expect 0 screen "$folder/renamed.csv" --like paper-fluid-1 --speeds 20,60 --weights 3,1 --pareto cost_of_drum
[ "$(campaign_of_output)" = "$campaign" ] || fail 'what decides no figure made another campaign'
expect 0 screen "$table" --like paper-fluid-1 --speeds 20,60
(ulimit -f 20 && "$client" screen --campaign "$campaign" --csv "$folder/cut.csv") \
  >"$folder/out" 2>"$folder/err" && fail 'a run without room for its file succeeded'
[ ! -e "$folder/cut.csv" ] || fail 'an incomplete file has its final name'
expect 0 screen --campaign "$campaign" --csv "$folder/again.csv"
cut -d, -f4- "$folder/whole.csv" >"$folder/whole.figures"
cut -d, -f4- "$folder/again.csv" | cmp - "$folder/whole.figures" || fail 'a campaign is read otherwise'
expect 0 screen --campaign "$campaign" --weights 1,3 --pareto cost --output json
out_is_json
expect 2 screen --campaign "$campaign" --weights 1,3,4
err_has '--weights'

echo "--- campaigns: a screening outlives its client and its server"
expect 0 campaigns list
out_has "^$campaign +succeeded +100 +800 +0 "
expect 0 campaigns list --limit 1 --output json
out_is_json
expect 0 campaigns show "$campaign"
out_has ' 800 .*\b400\b'
expect 0 campaigns show "$campaign" --output csv
out_is_csv
expect 0 campaigns columns "$campaign" --columns candidate,cost,mesh_loss_power_watts --start-row 2 --row-count 3 --output csv
out_lines 4
out_has '^1,2,[0-9.]+$'
expect 0 campaigns columns "$campaign"
err_has ' 19 of 800'
expect 0 campaigns columns "$campaign" --row-count 2 --output json
out_is_json
expect 0 campaigns rank "$campaign" --where 'cost<=5' --uncertainty relaxation-time=30%
out_has '^ *1 +[0-9]+ +[0-9]+ +[0-9]+\.[0-9]+ +[0-9.e-]+ +the best ' 'all 5 candidates' '395 '
expect 0 campaigns rank "$campaign" --count 3 --output csv
out_lines 4
out_is_csv
expect 0 campaigns rank "$campaign" --count 0 --output csv
out_lines 401
expect 2 campaigns rank "$campaign" --count 100001
err_has '100001.*100000'
expect 0 campaigns pareto "$campaign" --least cost
out_has ' cost'
expect 1 campaigns pareto "$campaign" --most mesh_loss_power_watts --least cots
err_has '^  --least cots: .*"cost"'
expect 0 campaigns effects "$campaign"
out_has '^lubricant\.relaxation_time_seconds '
expect 0 campaigns effects "$campaign" --columns cost --output csv
out_is_csv
out_has '^column,.*,warnings$' '^cost,'
printf '%s\n' name,relaxation_time_seconds,asperity_friction A,4e-7,1 B,5e-7,2 >"$table"
expect 0 screen "$table" --like paper-fluid-1 --carry asperity_friction
carrying=$(campaign_of_output)
printf '%s\n' name,relaxation_time_seconds,asperity_friction C,6e-7,3 >"$table"
expect 0 campaigns append "$carrying" "$table"
expect 2 campaigns append "$campaign" "$table"
err_has "'asperity_friction'"
! grep -q -e --carry "$folder/err" || fail 'campaigns append suggests --carry, a flag of screen'
expect 0 screen --campaign "$carrying"
out_has 'all 3 candidates'
expect 0 campaigns promote "$campaign" --candidate 7 --lubricant promoted-oil
out_has 'lubricants/promoted-oil'
expect 1 campaigns promote "$campaign" --candidate 7 --lubricant promoted-oil
err_has 'lubricants/promoted-oil'
expect 0 campaigns pause "$campaign" # has ended
expect 1 campaigns resume "$campaign"
{
  echo relaxation_time_seconds
  seq 60000 | sed 's/$/e-11/'
} >"$table"
expect 1 screen "$table" --like paper-fluid-1 --speeds 20,60,80 --budget-points 3000 --no-uncertainty
err_has 'campaigns/[0-9]+ .* [0-9]+ of 180000 '
campaign=$(grep -oE 'campaigns/[0-9]+' "$folder/err" | head -n 1 | grep -oE '[0-9]+$')
in_background running screen "$table" --like paper-fluid-1 --speeds 20,60,80 --no-uncertainty
interrupt
err_has "campaigns/$campaign .* [0-9]+ of 180000 " "tribodyn screen --campaign $campaign"
kill -9 "$server_pid"
wait "$server_pid" 2>/dev/null
start_server
expect 0 campaigns pause "$campaign"
out_has "^$campaign +paused"
expect 0 campaigns resume "$campaign" --points 20000
expect 0 campaigns cancel "$campaign"
expect 1 screen "$table" --like paper-fluid-1 --speeds 20,60,80 --no-uncertainty
err_has "tribodyn campaigns delete $campaign"
expect 0 campaigns delete "$campaign"
expect 1 campaigns delete "$campaign"
expect 0 campaigns delete "$campaign" --allow-missing

expect 0 sensitivities paper-fluid-1 --speed 100
out_has 'pressure viscosity coefficient .*\|#'
expect 0 sensitivities paper-fluid-1 --speed 75 --output csv
out_has '^parameter,unit,value,derivative.inefficiency_rms_percent,elasticity.inefficiency_rms_percent'
expect 0 point --lubricant paper-fluid-1 --speed 100 --sensitivities
out_has 'pressure viscosity coefficient .*\|#'
expect 0 curve --lubricant paper-fluid-1 --speeds 60,100 --sensitivities --no-uncertainty --csv "$folder/slopes.csv"
out_has '^ *lubricant pressure viscosity coefficient +-?[0-9.]+ +-?[0-9.]+$'
head -1 "$folder/slopes.csv" | grep -q ',elasticity.film_ratio.mean.wheel_torque,' || fail "tribodyn curve --csv: no sensitivities"

echo "--- screening on a rig in place of the axle"
{
  echo "name,pressure-viscosity (1/GPa),asperity_friction_coefficient,cost"
  for i in $(seq 24); do echo "oil $i,$((14 + i % 5)),0.0$((80 + i % 7)),$((30 - i))"; done
} >"$table"
expect 0 screen "$table" --like paper-fluid-1 --rig traction --surface run-in --srr 2,10,50 --temperature 40,100 \
  --pareto cost --effects --uncertainty pressure-viscosity=3% --csv "$folder/rig.csv"
out_has '^ *rank +candidate +name +traction_coefficient' '20 best of 24 ' 'traction_coefficient .*\b24\b'
on_rig=$(campaign_of_output)
[ "$(wc -l <"$folder/rig.csv")" -eq 145 ] || fail "a row for each of 24 candidates at 6 conditions"
head -n 1 "$folder/rig.csv" | grep -q '^name,candidate,.*,cost,load_newtons,.*,traction_coefficient,.*,refusal$' ||
  fail "the header of the rows of a rig"
expect 0 screen --campaign "$on_rig" --most central_film_thickness_metres:min --top 3
out_has '3 best of 24 ' 'central_film_thickness_metres'
expect 0 screen "$table" --like paper-fluid-1 --rig stribeck --output json
out_is_json
out_has '"ranking"'
cut -d , -f 1,2,4 "$table" >"$folder/smooth.csv"
expect 0 screen "$folder/smooth.csv" --like paper-fluid-1 --rig film --no-uncertainty
out_has 'central_film_thickness_metres'
on_film=$(campaign_of_output)
expect 0 campaigns show "$on_film"
out_has '\b24 .*\b13 '
expect 0 screen "$folder/smooth.csv" --like paper-fluid-1 --no-uncertainty
on_axle=$(campaign_of_output)
expect 0 campaigns pareto "$on_axle" --most "$on_film/central_film_thickness_metres:min"
out_has "central_film_thickness_metres .*campaigns/$on_film"
expect 1 campaigns pareto "$on_axle" --least "$on_rig/traction_coefficient"
err_has "campaigns/$on_rig .*campaigns/$on_axle"
expect 0 campaigns rank "$on_film" --where "$on_axle/inefficiency_energy_mean_percent<=100" --output csv
out_lines 21
expect 1 screen "$table" --like paper-fluid-1 --rig traction --radius 0.001mm --load 1e9
err_has '--radius'

echo "--- curve"
expect 0 curve --lubricant sheet-a --speed 40,60 --plot "$folder/bands.svg" --panels transmission-error,film-ratio
out_has ' (\+/- 0\.[0-9]+|[0-9.]+ to [0-9.]+) +0\.0'
pictures bands.svg
grep -q 'fill-opacity' "$folder/bands.svg" || fail "curve draws no bands"
expect 0 curve --lubricant sheet-a --speeds 40,60 --sumps 40,90 --no-uncertainty --output csv
out_lines 5
expect 0 curve --lubricant paper-fluid-1 --speeds 20,100 --compare isothermal,no-boundary,down \
  --model-preset paper --plot "$folder/variants.svg"
out_has '^ *20 +1\.3[0-9]+ +\+1[0-9]\.[0-9]{2} +-2[0-9]\.[0-9]{2}'
pictures variants.svg
expect 0 curve --lubricant paper-fluid-1 --lubricant paper-fluid-2,paper-fluid-3 --first-speed 40 --last-speed 60 --speed-step 10 \
  --model quasi-static --csv "$folder/curve.csv" --plot "$folder/curve.svg"
out_has '^lubricants/paper-fluid-3: '
head -1 "$folder/curve.csv" | grep -q ',estimated_relative_error,' || fail "curve.csv without errors"
[ "$(wc -l <"$folder/curve.csv")" -eq 10 ] || fail "curve.csv has not 1 + 9 lines"
pictures curve.svg
if command -v rsvg-convert >/dev/null; then
  rsvg-convert "$folder/curve.svg" -o "$folder/curve.png" || fail "curve.svg cannot be drawn"
fi
expect 0 curve --lubricant paper-fluid-1 --first-speed 40 --last-speed 60 --speed-step 10 \
  --model quasi-static --direction down --output csv
out_lines 4
out_has ',DOWN,'
expect 0 curve --lubricant paper-fluid-1 --first-speed 60 --last-speed 80 --speed-step 20 --independent-points \
  --output json
out_is_json
out_has '"simulations": \[' '"independent_points": true'
expect 0 curve --lubricant paper-fluid-1 --speed 40,20m/s --sump -5C --model quasi-static \
  --inlet-shear-heating=false --plot "$folder/cold.svg"
out_has 'INLET_HEATING_LEFT_OUT' '^ +72 '
for part in 'INLET_HEATING_LEFT_OUT' 'tribodyn-model' ' [0-9a-f]{12}'; do
  grep -qE "$part" "$folder/cold.svg" || fail "cold.svg without '$part'"
done

echo "--- history"
expect 0 history --lubricant paper-fluid-1 --speed 50 --model quasi-static --mesh-cycles 2 \
  --samples-per-mesh-cycle 16 --columns mesh_force_newtons,flank_load_newtons --output csv \
  --plot "$folder/history.svg"
out_lines 33
out_is_csv
out_has '^time_seconds,mesh_force_newtons,flank_load_newtons_flank_0'
pictures history.svg
expect 0 history --lubricant paper-fluid-1 --speed 50 --model quasi-static --samples-per-mesh-cycle 16
out_has 'dynamic_transmission_error_metres +16'
job=$(sed -n 's,^simulations/\([^:]*\):.*,\1,p' "$folder/out")
expect 0 history --simulation "$job" --output json
out_is_json
out_has '"total_rows": "16"'

echo "--- jobs"
long=(--lubricant paper-fluid-1 --label project=axle --first-speed 20 --last-speed 140 --speed-step 0.2 --method march \
  --march-step-tolerance 1e-11 --march-settling-tolerance 1e-12)
expect 0 curve "${long[@]}" --detach
job=$(sed -n 's,^simulations/\([^ ]*\) .*,\1,p' "$folder/out")
[ -n "$job" ] || fail "no name from --detach"
expect 0 jobs get "$job"
out_has 'running|queued'
expect 0 jobs get "$job" --output json
out_is_json
expect 0 jobs list
out_has "^$job"
expect 0 jobs list --label project=axle --output csv
out_lines 2
expect 0 jobs list --limit 2 --output json
out_is_json
[ "$(grep -c '"name": "simulations/' "$folder/out")" -eq 2 ] || fail "jobs list --limit 2: other jobs"

echo "--- Ctrl-C before the watch says what it leaves behind"
# interrupted_start PATTERN COMMAND...: interrupts the command while the server answers nothing.
interrupted_start() {
  local pattern=$1 socket
  shift
  kill -STOP "$server_pid"
  asked="$*, then Ctrl-C at once"
  "$client" "$@" >"$folder/out" 2>"$folder/err" </dev/null &
  client_pid=$!
  # Until the server has a call that it does not read, and SIGINT is handled.
  socket=$(printf ':%04X ' "${TRIBODYN_SERVER##*:}")
  until { grep -qE "^ *[0-9]+: [0-9A-F]+${socket}[^ ]+ 01 [0-9A-F]+:0*[1-9A-F]" /proc/net/tcp &&
    grep -qE '^SigCgt:.*[2367abef]$' "/proc/$client_pid/status"; } || ! kill -0 "$client_pid"; do
    sleep 0.02
  done
  interrupt
  kill -CONT "$server_pid"
  err_has "$pattern"
}
interrupted_start 'tribodyn jobs list' curve --lubricant paper-fluid-1,paper-fluid-2 --speeds 20,60
interrupted_start 'nothing was submitted' curve --lubricant paper-fluid-1 --speeds 20,60 --validate-only
interrupted_start 'nothing was submitted' screen --lubricants paper-fluid-1,paper-fluid-2 --speeds 20,60

echo "--- Ctrl-C stops the watch, not the job"
in_background running jobs watch "$job"
interrupt
err_has "tribodyn jobs watch $job" "tribodyn jobs cancel $job"
expect 0 jobs get "$job" --output csv
out_has 'RUNNING'
expect 0 jobs cancel "$job"
expect 1 jobs watch "$job"
expect 0 jobs cancel "$job" # has ended
err_has "simulations/$job"
expect 0 jobs list --filter 'state = cancelled AND lubricant = paper-fluid-1'
out_has "^$job .*cancelled"
expect 0 jobs pin "$job"
out_has "^$job .* yes "
expect 0 jobs list --filter 'pinned = true' --output csv
out_lines 2
expect 1 jobs list --filter 'stat = cancelled'
err_has 'tribodyn help filters'
expect 1 jobs delete "$job"
err_has "simulations/$job"
expect 0 jobs unpin "$job"
expect 1 jobs wait "$job"
expect 0 jobs delete "$job"
err_has "simulations/$job"
expect 1 jobs delete "$job"
expect 0 jobs delete "$job" --allow-missing

echo "--- a job is computed once, and again with --force"
point=(point --lubricant paper-fluid-2 --speed 50 --model quasi-static --output json)
expect 0 "${point[@]}"
expect 0 "${point[@]}"
out_has '"cache_hit": true'
name=$(sed -n 's,^ "name": "simulations/\(.*\)".*,\1,p' "$folder/out")
expect 0 "${point[@]}" --force
out_has '"cache_hit": false'
expect 0 jobs rerun "$name" --output json
out_has '"cache_hit": false' '"lubricant": "lubricants/paper-fluid-2@1"'
expect 0 jobs wait "$name" --output csv
out_has 'SUCCEEDED'
expect 0 jobs get "$name" --output json
cp "$folder/out" "$folder/before"
expect 1 point --lubricant paper-fluid-2 --speed 51 --deadline-seconds 0.001 --method march
err_has 'DEADLINE_EXCEEDED|deadline_seconds'

echo "--- projects; results outlive the server"
expect 1 --project axles lubricants list
err_has 'projects/axles'
stop_server
expect 3 jobs get "$name"
start_server --projects axles,gearboxes
expect 0 jobs get "$name" --output json
cmp -s "$folder/before" "$folder/out" || fail "the result of $name changed with a restart"
expect 0 --project axles lubricants create house-oil --like paper-fluid-1
out_has 'house-oil'
expect 0 --project axles lubricants list
out_has '^house-oil '
expect 0 lubricants list
out_lacks '^house-oil '
expect 1 lubricants get house-oil
expect 0 lubricants get projects/axles/lubricants/house-oil --output json
out_has '"name": "projects/axles/lubricants/house-oil"'
expect 0 --project axles lubricants get house-oil --output json
out_has '"name": "lubricants/house-oil"'
expect 0 --project axles point --lubricant house-oil --speed 50 --model quasi-static --output json
out_has '"name": "simulations/1"'
expect 0 --project axles point --lubricant house-oil --speed 51 --model quasi-static --detach
out_has 'tribodyn --project axles jobs watch 2'
TRIBODYN_PROJECT=axles expect 0 jobs wait 1 2
expect 0 --project axles lubricants update house-oil --density15 870
expect 0 --project axles lubricants revisions house-oil
out_has 'house-oil@2'
expect 1 --project gearboxes jobs get 1
expect 1 --project Axles jobs get 1

finish
