#!/usr/bin/env bash
# Drives every command of the command line against a real tribodynd: a free port on loopback, a
# database in a temporary folder.
# usage: command_line_test.sh TRIBODYND TRIBODYN
# shellcheck source=tests/client/support.sh
. "$(dirname "${BASH_SOURCE[0]}")/support.sh"

echo "--- without a server"
TRIBODYN_SERVER=127.0.0.1:9 expect 3 lubricants list
err_has 'cannot connect to the server at 127.0.0.1:9'
expect 3 --server "unix:$folder/none" lubricants list
expect 0 --help
out_has 'Exit codes'
for command in point curve compare explain report screen design sensitivities history spectrum contact viscosity traction film stribeck cycle roughness paper diff validate \
  schema completion help "lubricants list" \
  "lubricants get" "lubricants create" "gear-sets update" "surfaces import" "vehicles export" \
  "jobs list" "jobs get" "jobs watch" "jobs wait" "jobs cancel" "jobs rerun" "campaigns list" \
  "campaigns show" "campaigns pause" "campaigns resume" "campaigns cancel" "campaigns delete" "campaigns columns" \
  "campaigns rank" "campaigns pareto" "campaigns effects" "campaigns promote"; do
  # shellcheck disable=SC2086  # the words of a command
  expect 0 $command --help
  out_has '^Examples$'
  # shellcheck disable=SC2086
  expect 0 $command --help-all
  out_has '^  --server <HOST:PORT>$'
done
expect 0 curve --help
out_has '[0-9]+ more options: tribodyn curve --help-all'
expect 0 --version
expect 2
expect 2 pointt --speed 3
err_has 'is point meant'

start_server

echo "--- usage: every error at once"
expect 2 point --speed fast --sump hot --model quick --nonsense
for part in "'fast' is not a number" "'hot' is not a number" "'quick' must be one of" \
  "unknown option --nonsense" "--lubricant is missing"; do
  err_has "$part"
done

echo "--- errors of the server: every violation at once"
expect 1 point --lubricant paper-fluid-7 --speed -5 --sump-temperature-celsius 900 \
  --march-step-tolerance 1 --gear-set Z
for part in '--speed = -5 km/h; allowed: 0\.1 to 400' \
  '--sump-temperature-celsius = 900 C; allowed: -70 to 200' '--march-step-tolerance = 1; allowed' \
  'lubricants/paper-fluid-7' 'gearSets/Z'; do
  err_has "$part"
done
expect 1 contact --load-newtons -1 --radius-x-metres 0 --poissons-ratio 0.7
for part in '--load-newtons = -1 N' '--radius-x-metres = 0 m' '--poissons-ratio = 0.7'; do
  err_has "$part"
done
expect 1 history --lubricant paper-fluid-1 --speed 50 --columns mesh_force_newton,nothing --samples-per-mesh-cycle 1
for part in 'mesh_force_newtons' '--columns' '--samples-per-mesh-cycle = 1'; do
  err_has "$part"
done
expect 1 curve --lubricant paper-fluid-1,paper-fluid-8 --first-speed 90 --last-speed 20
for part in 'lubricants/paper-fluid-8' '--last-speed = 20'; do
  err_has "$part"
done
expect 1 lubricants get none
expect 1 jobs get none
expect 1 jobs cancel none
expect 1 jobs watch none

echo "--- allowed ranges in the help equal those of the server"
# The server must reject a value above the range of each number flag and state the same range.
ranges() {  # joins the wrapped lines of each flag first
  "$client" "$1" --help-all | awk '
    function show() { if (match(text, /Allowed: [^ ]+ to [^ ]+/)) {
      split(substr(text, RSTART, RLENGTH), word); print flag, word[2], word[4] } text = "" }
    /^  --/ { show(); flag = $1; sub(/,$/, "", flag); next }
    /^ / { sub(/^ +/, ""); text = text " " $0; next }
    { show() }
    END { show() }' | sed 's/\.$//'
}
same_numbers() { awk 'BEGIN { exit !(ARGV[1] + 0 == ARGV[3] + 0 && ARGV[2] + 0 == ARGV[4] + 0) }' "$@"; }
checked=0
for command in point contact history curve; do
  while read -r flag lowest highest; do
    given=(--lubricant paper-fluid-1 --speed 50)
    case "$command $flag" in
      *" --timeout-seconds") continue ;;  # the client checks it
      contact\ *) given=() ;;
      curve\ * | *" --speed-kilometres-per-hour" | *" --speeds-kilometres-per-hour") given=(--lubricant paper-fluid-1) ;;
      *" --pinion-torque-newton-metres") given=(--lubricant paper-fluid-1 --pinion-speed 1) ;;
      *" --pinion-speed-radians-per-second") given=(--lubricant paper-fluid-1 --torque 1) ;;
    esac
    case "$flag" in
      *-mesh-cycles | *-mesh-cycle) value=$((highest + 1)) ;;
      *) value=$(awk -v v="$highest" 'BEGIN { printf("%.9g", v * 1.001) }') ;;
    esac
    expect 1 "$command" "${given[@]}" "$flag" "$value"
    read -r server_lowest server_highest < <(
      sed -n "s/^ *$flag = .*; allowed: \\([^ ]*\\) to \\([^ ]*\\).*/\\1 \\2/p" "$folder/err")
    same_numbers "$lowest" "$highest" "${server_lowest:-none}" "${server_highest:-none}" ||
      fail "$command $flag: help says $lowest to $highest"
    checked=$((checked + 1))
  done < <(ranges "$command")
done
[ "$checked" -ge 45 ] || fail "only $checked ranges found in the help"

echo "--- lubricants"
expect 0 lubricants list
out_has '^paper-fluid-1 .*ester-olefin'
out_has '^paper-fluid-3 '
out_has '^shell-t9 '
expect 0 lubricants list --output csv
out_is_csv
out_lines 5
out_has 'pressure_viscosity_coefficient_per_pascal'
expect 0 lubricants list --output json
out_is_json
out_has '"lubricants": \['
expect 0 lubricants get paper-fluid-2
out_has 'relaxation time +0.45  us'
expect 0 lubricants get lubricants/paper-fluid-2 -o json
out_is_json
out_has '"pressure_viscosity_coefficient_per_pascal": 1.931e-0?8'
expect 0 lubricants get paper-fluid-2 -o csv
out_lines 2

echo "--- contact"
expect 0 contact
out_has 'central film thickness +h_cen +[0-9.]+ +um +12'
out_has 'specific sliding, pinion +V_s/\|U_p\| +[0-9.]+'
out_has 'Taken as exact, because no uncertainty is stated: '
out_has '(^|, | )relaxation time(,|$)'
expect 0 contact --lubricant paper-fluid-2 --newtonian --output csv
out_is_csv
out_lines 2
expect 0 contact --output json
out_is_json
out_has '"central_film_thickness_metres": [0-9.]+e-0?[67]'

echo "--- rigs"
expect 0 traction paper-fluid-1 paper-fluid-2 --radius 12.7mm --load 38,154 --isothermal
out_has '^paper-fluid-1@1 +thermal +38 +2 +0 +40 +0 '
out_has '^paper-fluid-2@1 +isothermal +154 +2 +50 +40 +0\.0[0-9]+ '
expect 0 film paper-fluid-1 --speed 0.1,1 --output csv
out_is_csv
out_lines 3
out_has '^lubricant,model,load_newtons,entrainment_speed_metres_per_second'
printf 'entrainment_speed_metres_per_second,traction_coefficient,load_newtons\n0.01,0.1,20\n1,0.04,20\n' >"$folder/rig.csv"
expect 0 stribeck paper-fluid-1 --measured "$folder/rig.csv" --load 20 --plot "$folder/stribeck.svg"
out_has 'paper-fluid-1@1: RMS residual [0-9.]+ % of 2 measured points'
[ -s "$folder/stribeck.svg" ] || fail "stribeck draws nothing"
expect 0 stribeck paper-fluid-1 --measured "$folder/rig.csv" --output json
out_is_json
sed -i 's/0.04/0,04x/' "$folder/rig.csv"
expect 2 stribeck paper-fluid-1 --measured "$folder/rig.csv"
expect 1 traction paper-fluid-11
expect 1 traction paper-fluid-1 --slide-roll-ratio 5,300
err_has '^  --slide-roll-ratio = 300 %; allowed: -200 to 200 %'
expect 1 traction paper-fluid-1 --load 35,-5
err_has '^  --load = -5 N; allowed: 1e-06 to 1000000 N'
expect 2 traction

expect 0 traction paper-fluid-1 paper-fluid-2 --map slide-roll-ratio,pressure --plot "$folder/map.svg"
out_has '^paper-fluid-1@1: Traction coefficient$'
out_has '^across: Slide-roll ratio, % of the mean speed; down: Mean pressure, GPa$'
out_has '^1\.5 +0 '
[ -s "$folder/map.svg" ] || fail "traction draws no map"
expect 0 film paper-fluid-1 --map temperature,speed --temperature 40,60,90 --speed 0.1,1 --output csv
out_lines 7
expect 2 traction paper-fluid-1 --map load,pressure
err_has 'two different settings, not load and pressure together'
expect 2 traction paper-fluid-1 --map speed,viscosity
err_has "unknown setting 'viscosity'; allowed: two of slide-roll-ratio, temperature, speed, load, pressure"
expect 0 traction paper-fluid-1 --pressure 0.8GPa --srr 10 --output csv
out_lines 2

echo "--- viscosities and spectra"
expect 0 viscosity paper-fluid-1 shell-t9 --plot "$folder/viscosity.svg"
out_has '^oil +density +kinematic +dynamic +alpha\* +ambient +0\.5 GPa +1 GPa$'
out_has '^ *40 +818\.1 +[0-9.]+ +[0-9.]+ +16\.09 '
[ -s "$folder/viscosity.svg" ] || fail "viscosity draws nothing"
expect 0 viscosity paper-fluid-1 --temperature 40,100 --pressure 0,1GPa --output csv
out_is_csv
out_lines 5
expect 0 viscosity paper-fluid-1 --output json
out_is_json
expect 2 viscosity
expect 1 viscosity paper-fluid-11
expect 0 spectrum --lubricant paper-fluid-1 --speed 65 --plot "$folder/spectrum.svg"
out_has '^Order 1 is the mesh frequency, [0-9.]+ Hz\. Amplitudes from zero to peak, over 1 mesh cycle of 192'
[ -s "$folder/spectrum.svg" ] || fail "spectrum draws nothing"
expect 0 spectrum --lubricant paper-fluid-1 --speed 65 --maximum-order 4 --output csv
out_is_csv
out_lines 5
out_has '^order,amplitude_dynamic_transmission_error_metres,phase_angle_radians_dynamic_transmission_error_metres,'

# Drive cycles: the energy of the map is within its stated error of the point-by-point integration.
# Sanitizers slow the NEDC to a minute: under them only short cycles run.
if [ -z "${TRIBODYN_SHORT_RUN:-}" ]; then
  energy_of() { awk -F, '$1 == "all" { print $5 }' "$folder/out"; }
  expect 0 cycle paper-fluid-1 paper-fluid-2 --plot "$folder/cycle.svg" --csv "$folder/pieces.csv"
  out_has '^all +1180 +11\.028 '
  out_has '^standstill +280 +0\.000 '
  out_has '^paper-fluid-2@1: estimated error of the map [0-9.]+ kJ, of the solver at most [0-9.]+ kJ, [0-9]+ points'
  stated=$(sed -nE 's/^paper-fluid-1@1: estimated error of the map ([0-9.]+) kJ.*/\1/p' "$folder/out")
  [ -s "$folder/cycle.svg" ] && [ "$(wc -l <"$folder/pieces.csv")" -eq 1181 ] || fail "tribodyn cycle: files"
  expect 0 cycle paper-fluid-1 --output csv
  by_map=$(energy_of)
  expect 0 cycle paper-fluid-1 --point-by-point --output csv
  awk -v one="$by_map" -v other="$(energy_of)" -v stated="$stated" \
    'BEGIN { d = one - other; exit !(other > 0 && d * d <= 1e6 * stated * stated) }' ||
    fail "tribodyn cycle: $by_map J by the map, $(energy_of) J point by point, stated error $stated kJ"
fi
printf 'time_seconds,speed_kilometres_per_hour,ascent_angle_degrees\n0,0,0\n5,30,2\n20,30,-1\n25,0,0\n' >"$folder/own.csv"
expect 0 cycle paper-fluid-1 --cycle "$folder/own.csv" --output json
out_is_json
expect 0 cycle paper-fluid-1 --cycle "$folder/own.csv" --point-by-point
out_has 'point by point, of the solver at most [0-9.]+ kJ, [0-9]+ points'
printf 'time_seconds,speed_kilometres_per_hour\n0,0\n5,x\n' >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 --cycle "$folder/bad.csv"
err_has "bad.csv, line 3, speed_kilometres_per_hour: 'x' is not a number"
printf 'time_seconds,speed_kilometres_per_hour\n0,0\n5,-10\n' >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 --cycle "$folder/bad.csv"
err_has 'bad.csv, line 3, speed_kilometres_per_hour: speed_kilometres_per_hour = -10 km/h; allowed: 0 to 400'
printf '# own\n\ntime_seconds,speed_kilometres_per_hour\n0,0\n5,20\n5,300\n5.5,10\n' >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 paper-fluid-11 --cycle "$folder/bad.csv"
err_has 'did you mean "lubricants/paper-fluid-1"'
err_has 'bad.csv, line 6, time_seconds: time_seconds = 5 s; allowed: above that of the place before, 5 s'
err_has 'bad.csv, line 7, speed_kilometres_per_hour: .* acceleration of -161.1 m/s2; allowed: -50 to 50 m/s2'
printf 'Time (s),speed\n0,10\n' >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 --cycle "$folder/bad.csv"
err_has 'bad.csv: unknown column Time \(s\) \(is time_seconds meant\?\); allowed: time_seconds'
printf 'time_seconds,speed_kilometres_per_hour\n0,10\n' >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 --cycle "$folder/bad.csv"
err_has 'bad.csv: 1 place; allowed: two places or more'
{ echo time_seconds,speed_kilometres_per_hour; seq 1000000 | sed 's/$/,50/'; } >"$folder/bad.csv"
expect 1 cycle paper-fluid-1 --cycle "$folder/bad.csv"
err_has 'bad.csv has 1000000 rows; allowed: at most 10000'
printf 'time_seconds,speed_kilometres_per_hour,sump_temperature_celsius\n0,60,40\n60,60,90\n' >"$folder/own.csv"
expect 0 cycle paper-fluid-1 --cycle "$folder/own.csv"
out_has 'own.csv, sump 40.42 to 89.58 C: mesh loss'
expect 2 cycle
expect 2 cycle paper-fluid-1 --map-tolerance 1
expect 2 cycle paper-fluid-1 --map-tolerance 0
expect 1 cycle paper-fluid-1 --cycle "$folder/own.csv" --point-by-point --map-tolerance 1e-3
err_has 'map-tolerance = 0.001 has no effect: with point_by_point'

# Measured profiles: six are one surface, whose parameters move with the sampling interval.
for place in heel middle toe; do
  awk -v place="$place" 'BEGIN { srand(length(place)); z = 0; print "position_micrometres,height_nanometres"
    for (i = 0; i < 1000; ++i) { print i "," z; z = 0.99 * z + 60 * (rand() - 0.5) } }' >"$folder/$place.csv"
done
expect 0 roughness {pinion,gear},axial,"$folder"/{heel,middle,toe}.csv --plot "$folder/roughness.svg"
out_has '^pinion, axial +3 '
out_has '^ +16 +16 .* ± '
[ -s "$folder/roughness.svg" ] || fail "tribodyn roughness: plot"
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
err_has 'allowed: 1 to 200'
expect 2 roughness
expect 2 roughness "$folder/heel.csv" --sampling-steps 1,x
expect 2 roughness wheel,"$folder/heel.csv"
err_has 'is not \[pinion|gear,\]'

# Figures of the paper, by their numbers.
expect 0 paper 10 --output "$folder/paper"
out_has '^Figure 10: Inefficiency of lubricant 1, isothermal and thermal$'
out_has '^  holds: The isothermal prediction lies above the thermal one at every speed$'
out_has 'Variants tried.*limiting stress'
for file in index.html figure-10.svg figure-10.csv findings.csv; do
  [ -s "$folder/paper/$file" ] || fail "tribodyn paper 10: no $file"
done
expect 0 paper 9 14 --output csv
out_has '^figure,statement,verdict,quantity,unit,at,value$'
out_has '^14,'
expect 0 paper 9 -o json
out_is_json
expect 2 paper 17
err_has 'must be one of 5\|6'
expect 1 paper 9 --output "$folder/no/such"
expect 0 paper --help-all
out_has '--output, -o <DIR>'
out_lacks '--output, -o <table'

echo "--- point"
expect 0 point --lubricant paper-fluid-1 --speed-kilometres-per-hour 72.5 --solver-details --progress lines
for part in 'inefficiency, energy mean +[0-9.]+ %' 'inefficiency, RMS' 'mesh loss +[0-9.]+ W' \
  'film ratio lambda' 'contact loss' 'model version' 'input hash +[0-9a-f]{64}' \
  'relative solver error +0\.[0-9]+ +%' 'right-hand sides' 'assumed'; do
  out_has "$part"
done
err_has 'lubricants/paper-fluid-1: succeeded'
expect 0 point --lubricant paper-fluid-1 --speed 50 --model quasi-static --isothermal --assumptions
out_has 'model used +quasi-static +as requested'
out_has 'relative solver error +[0-9.]+ +%'
out_has 'model: isothermal'
out_has 'asperity_radius_metres'
expect 0 point --lubricant paper-fluid-1 --speed 50 --model quasi-static --output csv
out_lines 2
out_has ',mesh_loss_power_watts,'
expect 0 point --lubricant paper-fluid-1 --speed 50 --model quasi-static --output json
out_is_json
out_has '"inefficiency_energy_mean_percent": [0-9]'
expect 0 point --lubricant paper-fluid-1 --speed 50 --pressure-limit 1.8GPa --flash-temperature-limit 5 \
  --limit-source 'FZG A/8.3/90'
for part in 'mesh friction coefficient +0\.0[0-9]+' 'flank slot 1 .*; friction coefficient 0\.0' \
  'specific sliding, gear' 'film ratio lambda, smallest +[0-9.]+ +>= 1 ' \
  'pressure, greatest +GPa +0\.[0-9]+ +<= 1\.8 +yes +stated: FZG A/8\.3/90' \
  'flash temperature rise, greatest +K +[0-9.]+ +<= 5 +no +stated: FZG'; do
  out_has "$part"
done
expect 1 point --lubricant paper-fluid-1 --speed 50 --pressure-limit 1
err_has '--pressure-limit.* allowed: '
expect 0 point --lubricant paper-fluid-1 --speed 72.5 --model quasi-static
out_has 'relative solver error +not estimated'
expect 0 point --lubricant paper-fluid-1 --speed 1
out_has 'model used +quasi-static +its estimated error is within the tolerance'
expect 0 point --lubricant paper-fluid-1 --speed 50 --model automatic
out_has 'model used +full \(4 degrees of freedom\) +the error of a cheaper model may'
expect 0 point --lubricant paper-fluid-1 --model quasi-static --pinion-torque-newton-metres 60 \
  --pinion-speed-radians-per-second 200
out_has 'pinion torque 60 N m at 200 rad/s'
expect 0 point --lubricant paper-fluid-1 --model quasi-static --speed 50 --acceleration 0.5 --ascent -1
out_has '50 km/h accelerating at 0.5 m/s2, ascent -1 degrees'

echo "--- uncertainty, comparison, sensitivities"
expect 0 lubricants create sheet-a --kv40 103 --kv100 15.1 --density15 868 --base-oil-class pao
expect 0 lubricants create sheet-b --kv40 100 --kv100 14.9 --density15 866 --base-oil-class pao
expect 0 point --lubricant sheet-a --speed 60
out_has 'inefficiency, energy mean: [0-9.]+ % \+/- 0\.[0-9]+ \(inputs\) \+/- 0\.0[0-9]+ \(solver\)'
out_has 'measure first: pressure viscosity$|measure first: pressure viscosity coefficient'
expect 0 traction sheet-a paper-fluid-1 --draws 49 --plot "$folder/bands.svg"
out_has '\+/-'
out_has 'from 49 draws'
out_has 'paper-fluid-1@1: no stated uncertainty of an input moves the traction coefficient'
out_lacks 'Taken as exact.*: \.$'
grep -q 'Bands: 95 % intervals' "$folder/bands.svg" || fail "traction draws no bands"
expect 0 film sheet-a --output csv
out_has ',central_film_thickness_metres_standard_uncertainty,'
expect 0 stribeck sheet-a --draws 0 --output json
out_is_json
out_lacks 'interval'
expect 1 traction sheet-a --draws 5
err_has '--draws.*19'
expect 0 compare sheet-a sheet-b --speed 40,60
out_has '^sheet-b@1 against sheet-a@1'
out_has 'these two cannot be told apart'
out_has 'Probability that sheet-b@1 loses less: [0-9]+ %'
expect 0 compare paper-fluid-1 paper-fluid-2 --speed 60
out_has 'Taken as exact'
expect 0 compare sheet-a --speed 60 --output csv
out_lines 2
out_has ',inefficiency_energy_mean_percent_standard_uncertainty,'
expect 0 compare sheet-a sheet-b --speed 60 --draws 19 --output json
out_is_json
out_has '"verdict": "CANNOT_BE_TOLD_APART"'
expect 2 compare
err_has 'give lubricants'
expect 2 compare sheet-a --speed 40,60 --weights 1
err_has '1 weight of 2 speeds'
expect 1 compare sheet-a no-such-oil
err_has 'lubricants/no-such-oil'
expect 0 compare sheet-a sheet-b --speed 40,60 --sumps 40,90 --weights 2,1 --sump-weights 1,3 --draws 19 \
  --plot "$folder/compared.svg"
out_has 'Mean of 4 conditions'
out_has '^ +60 +90 '
out_has 'tribodyn explain sheet-.@1 sheet-.@1 --speed 40,60 --weights 6,3 --sump 90$'
grep -q 'sheet-b@1, 90 C' "$folder/compared.svg" || fail 'no line for the second sump temperature'
expect 2 compare sheet-a --sumps 40,90 --sump-weights 1
err_has '1 weight of 2 sump temperatures'

echo "--- from data sheets to a decision in three commands"
cat >"$folder/oils.csv" <<'SHEETS'
name,base oil,KV40 (mm2/s),KV100 (mm2/s),KV100 after shear (mm2/s),density 15 C (g/cm3)
75W-90,PAO,103,15.1,14.2,0.868
75W-85,PAO,66.5,11.4,10.9,0.857
75W-80,Gr. III,52.4,9.1,,0.851
75W-90-ester,Ester,98,15.6,15.3,0.921
80W-90,Gr. I,138,14.3,,0.892
SHEETS
expect 0 lubricants import "$folder/oils.csv"
out_has '^Next:  tribodyn compare 75W-90 75W-85 75W-80 75W-90-ester 80W-90 --speed 30,60,90,120$'
expect 0 compare 75W-90 75W-85 75W-80 75W-90-ester 80W-90 --speed 30,60,90,120 --sump 80
for answer in '^ +1 +75W-[0-9a-z-]+@1 +[0-9.]+ .* the best$' \
  '^ +5 +80W-90@1 +[0-9.]+ +[0-9.]+ +[<0-9 ]+ % +[0-9.]+ +-?[0-9.]+ to [0-9.]+ ' \
  '^  What to measure next, to tell ' \
  '^  tribodyn explain 75W-[0-9a-z-]+@1 80W-90@1 --speed 30,60,90,120 --sump 80$' \
  '^  tribodyn report 75W-90 75W-85 75W-80 75W-90-ester 80W-90 --sump 80 --html report.html$'; do
  out_has "$answer"
done
tr -s ' \n' ' ' <"$folder/out" >"$folder/one_line"
for answer in 'probability that it is the best of all 5: [0-9]+ %' 'cannot be told apart from it' \
  'from 75W-[0-9a-z-]+@1: pressure viscosity coefficient[a-z 0-9@W-]*, which makes [0-9]+ %'; do
  grep -qE "$answer" "$folder/one_line" || fail "compare: no '$answer'"
done
explain=$(grep -oE 'explain 75W-[0-9a-z-]+@1 80W-90@1 .*' "$folder/out")
# shellcheck disable=SC2086
expect 0 $explain --draws 19
out_has '^  80W-90@1 loses [0-9.]+ percentage points more than 75W-'
out_has '^difference +[0-9.]+ .* 100 '
printf 'name,kv40\n75W-90 new,100\n' >"$folder/blank.csv"
expect 1 lubricants import "$folder/blank.csv"
err_has 'did you mean "75W-90-new"'

echo "--- explanation"
expect 0 explain paper-fluid-1 paper-fluid-3 --speed 40,100 --plot "$folder/why.svg"
out_has '^viscosity and its temperature law +-?[0-9.]+ '
out_has '^shear thinning \(equal\) +0\.0'
out_has '^difference +-?[0-9.]+ +100 '
out_has '^share, % points +40 +100'
grep -q '</svg>' "$folder/why.svg" || fail 'no picture of the shares'
expect 0 explain sheet-a sheet-b --speed 40 --draws 19 --output csv
out_lines 13
out_has '^lubricants/sheet-a@1,lubricants/sheet-b@1,one,40,'
expect 0 explain paper-fluid-1 paper-fluid-3 --output json
out_is_json
expect 2 explain paper-fluid-1
err_has 'give two lubricants'
expect 2 explain paper-fluid-1 paper-fluid-3 --speed 40,60 --weights 1
err_has '1 weight of 2 speeds'
expect 1 explain paper-fluid-1 no-such-oil
err_has 'lubricants/no-such-oil'
expect 0 lubricants create sheet-c --kv40 103 --kv100 15.1 --kv100-sheared 13.6 --density15 868 --base-oil-class pao
expect 0 point --lubricant sheet-c --speed 60 --condition sheared --assumptions
out_has 'lubricant after the shear test'
out_has 'viscosities times 0\.9007'
out_has 'film ratio lambda, minimum: [0-9.]+ .*\(inputs\), 95 %'
out_has 'contact temperature, maximum: [0-9.]+ C'
out_has 'mesh friction coefficient: 0\.0[0-9]+ \+/- 0\.0[0-9]+ \(inputs\), 95 %'
expect 0 contact --lubricant sheet-c
out_has 'friction coefficient +mu +0\.[0-9]+ +0\.[0-9]+'
out_has 'measure first: '
expect 0 contact --lubricant sheet-c --output csv
out_has ',friction_coefficient_standard_uncertainty'
expect 0 explain sheet-c sheet-c --other-condition sheared --draws 19
out_has '^viscosity and its temperature law +-?[0-9.]+ '
expect 1 point --lubricant sheet-a --speed 60 --condition sheared
err_has '--condition.* states no viscosity after the shear test'
expect 0 help models
grep -E '^  [a-z-]+ +[-+][0-9.]+ +[-+][0-9.]+ +[-+][0-9.]+$' "$folder/out" >"$folder/stated"
words=$(awk '{ printf "%s%s", (NR > 1 ? "," : ""), $1 }' "$folder/stated")
expect 0 curve --lubricant paper-fluid-1 --speeds 20,60,100 --tolerance 1e-5 --compare "$words"
# The last three lines: speed, inefficiency, then a column for each choice.
tail -n 3 "$folder/out" | awk -v words="$words" '
  { for (i = 3; i <= NF; ++i) changes[i - 2] = changes[i - 2] " " $i }
  END { n = split(words, name, ","); for (i = 1; i <= n; ++i) print name[i] changes[i] }' >"$folder/computed"
awk '{ print $1, $2, $3, $4 }' "$folder/stated" | diff - "$folder/computed" >"$folder/err" && [ -n "$words" ] ||
  fail 'help models states other changes than curve --compare computes'
expect 0 help columns
out_has '^Columns of results'
expect 0 schema
out_has '^mesh_loss_power_watts +W +mean loss power of the mesh'
out_has '^flank_sliding_speed_metres_per_second +m/s +sliding speed'
out_has '^flank_losses_0_friction_coefficient +'
echo "--- report"
expect 0 report sheet-a sheet-b --speeds 40,100 --html "$folder/report.html"
out_has 'report\.html'
for part in '<h2>Which loses less' '<td>cannot be told apart</td>' 'aria-label="Inefficiency against speed"' \
  '<h2>Why sheet-b@1 differs from sheet-a@1' 'measure first: pressure viscosity' '+/- ' \
  'tribodyn report sheet-a@1 sheet-b@1 --speeds 40,100'; do
  grep -qF -- "$part" "$folder/report.html" || fail "the report has no '$part'"
done
grep -Eq 'https?://[^w]' "$folder/report.html" && fail 'the report refers to another place'
expect 0 report paper-fluid-1 --speeds 40 --html "$folder/alone.html"
expect 2 report paper-fluid-1
err_has 'give the page to write: --html FILE.html'
echo "--- screening"
table=$folder/candidates.csv
printf '%s\n' 'name;treat rate;pressure-viscosity (1/GPa);asperity friction coefficient' \
  'good;0,5;15,5;0,09' 'bad;1;19;0,12' 'like the base;0;;' 'slip;2;16e-9;' >"$table"
expect 0 screen "$table" --like paper-fluid-1 --speeds 20,60 --sumps 40,90 --weights 1,3
out_has '^ *1  good +[0-9.]+ +[0-9.]+ +-[0-9.]+'
out_has '^ *2  like the base +[0-9.]+ +[0-9.]+ +0\.00 '
out_has 'slip: pressure-viscosity \(1/GPa\) = 1.6e-17 1/Pa; allowed'
err_has 'cells have a decimal comma'
expect 0 screen "$table" --like paper-fluid-1 --output csv
out_lines 5
out_has '^1,good,0\.5,15\.5,0\.09,[0-9.]+,'
expect 0 screen "$table" --like paper-fluid-1 --output json
out_is_json
expect 0 screen "$table" --like paper-fluid-1 --uncertainty pressure-viscosity=30% --pareto 'treat rate' \
  --plot "$folder/screen.svg"
out_has '^ *2  like the base .* tie, [0-9]+ %'
out_has 'Errors of each candidate alone: pressure viscosity coefficient'
out_has '^Pareto front: least inefficiency and least treat rate'
grep -q '</svg>' "$folder/screen.svg" || fail 'no picture of the front'
expect 0 screen "$table" --like paper-fluid-1 --pareto 'treat rate' --output json
out_is_json
expect 2 screen "$table" --like paper-fluid-1 --pareto 'treat rate' --output csv
err_has 'use --output json for --pareto'
expect 2 screen "$table" --like paper-fluid-1 --pareto 'treat rat'
err_has 'is treat rate meant'
expect 0 design --range pressure-viscosity=14/GPa:18/GPa --range asperity-friction-coefficient=0.05:0.12 --count 16
out_lines 17
cp "$folder/out" "$table.design"
expect 0 screen "$table.design" --like paper-fluid-1 --effects
out_has '^pressure_viscosity_coefficient_per_pascal +1\.'
out_has 'explains [0-9.]+ % of the variance'
expect 0 design --uncertainties-of sheet-a --count 4 --method latin-hypercube
out_has '^candidate,pressure_viscosity_coefficient_per_pascal,'
expect 2 design --range pressure-viscosity=18/GPa:14/GPa --method grid --count 3
err_has 'must have a LOW below its HIGH'
err_has '--count does not apply to a grid'
printf '%s\n' name,kv40,kv100 A,73.3,8.86 B,9,73 >"$table"
expect 0 screen "$table" --like paper-fluid-1
out_has '^ *1  A  '
out_has 'B: A kinematic viscosity of 73 mm2/s at 100 C must be below'
expect 2 screen "$table" --like paper-fluid-1 --weights 1,2 --csv "$folder/x" --jsonl "$folder/y"
err_has '2 weights of 1 speed;'
err_has 'give either --csv or --jsonl'
expect 1 screen "$table" --like no-such-oil --speeds 900
err_has '--speeds = 900 km/h'
err_has '"lubricants/no-such-oil" does not exist'
{
  echo relaxation_time_seconds,cost
  seq 400 | sed 's/.*/&e-9,&/'
} >"$table"
expect 0 screen "$table" --like paper-fluid-1 --speeds 20,60 --csv "$folder/whole.csv"
out_has 'The server keeps the figures as campaigns/[0-9]+'
campaign=$(grep -oE 'screen --campaign [0-9]+' "$folder/out" | grep -oE '[0-9]+$')
expect 0 screen "$table" --like paper-fluid-1 --speeds 20,60 --jsonl "$folder/points.jsonl"
out_has "campaigns/$campaign:"
[ "$(wc -l <"$folder/points.jsonl")" -eq 800 ] || fail 'JSON lines are missing'
"$client" screen "$table" --like paper-fluid-1 --speeds 20,60 --jsonl /dev/fd/3 3>&1 >/dev/null 2>&1 |
  cmp - "$folder/points.jsonl" || fail 'a pipe gets other JSON lines than a file'
(ulimit -f 20 && "$client" screen "$table" --like paper-fluid-1 --speeds 20,60 --csv "$folder/cut.csv") \
  >"$folder/out" 2>"$folder/err" && fail 'a run without room for its file succeeded'
[ ! -e "$folder/cut.csv" ] || fail 'an incomplete file has its final name'
expect 0 screen --campaign "$campaign" --csv "$folder/again.csv"
out_has 'Carried along: cost'
cut -d, -f4- "$folder/whole.csv" >"$folder/whole.figures"
cut -d, -f4- "$folder/again.csv" | cmp - "$folder/whole.figures" || fail 'a campaign is read otherwise'
expect 0 screen --campaign "$campaign" --weights 1,3 --pareto cost --output json
out_is_json
expect 2 screen --campaign "$campaign" --weights 1,3,4
err_has '3 weights of 2 speeds'
expect 2 screen "$table" --campaign "$campaign" --speeds 20 --tolerance 1e-4
err_has 'a table and --campaign'
err_has '--speeds and --campaign'
err_has '--tolerance and --campaign'

echo "--- campaigns: a screening outlives its client and its server"
expect 0 campaigns list
out_has "^$campaign +succeeded +100 +800 +0 "
expect 0 campaigns list --limit 1 --output json
out_is_json
expect 0 campaigns show "$campaign"
out_has 'points computed +800 +of 800, 400 candidates at 2 conditions'
expect 0 campaigns show "$campaign" --output csv
out_is_csv
expect 0 campaigns columns "$campaign" --columns candidate,cost,mesh_loss_power_watts --start-row 2 --row-count 3 --output csv
out_lines 4
out_has '^1,2,[0-9.]+$'
expect 0 campaigns columns "$campaign"
err_has 'Rows 0 to 19 of 800'
expect 0 campaigns columns "$campaign" --row-count 2 --output json
out_is_json
expect 1 campaigns columns "$campaign" --columns mesh_los_power_watts
err_has 'mesh_loss_power_watts'
expect 0 campaigns rank "$campaign" --where 'cost<=5' --uncertainty relaxation-time=30%
out_has '^ *1 +[0-9]+ +[0-9]+ +[0-9]+\.[0-9]+ +[0-9.e-]+ +50\.0 +best'
out_has 'tie'
out_has '5 of 5 candidates'
out_has '395 violate a constraint'
expect 0 campaigns rank "$campaign" --count 3 --output csv
out_lines 4
out_is_csv
expect 0 campaigns pareto "$campaign" --least cost
out_has 'No other candidate is better in both'
expect 2 campaigns pareto "$campaign"
err_has 'give one or two of --least FIGURE and --most FIGURE'
expect 1 campaigns pareto "$campaign" --most mesh_loss_power_watts --least cots
err_has '^  --least cots: no such column here; did you mean "cost"'
expect 1 campaigns pareto "$campaign" --least film_ratio_minimun
err_has '^  --least film_ratio_minimun: no such column here'
expect 2 campaigns rank "$campaign" --least cost:median --where cost=3
err_has 'is not COLUMN, COLUMN:min, COLUMN:max or COLUMN:mean'
err_has 'is not FIGURE>=VALUE or FIGURE<=VALUE'
expect 0 campaigns effects "$campaign"
out_has 'cost \(follows from the columns before it\)'
expect 1 campaigns rank "$campaign" --least cots
err_has '^  --least cots: no such column here; did you mean "cost"'
printf '%s\n' name,relaxation_time_seconds,asperity_friction A,4e-7,1 B,5e-7,2 >"$table"
expect 2 screen "$table" --like paper-fluid-1
err_has "column 'asperity_friction' is no parameter \(is asperity_friction_coefficient meant\?\); --carry"
expect 0 screen "$table" --like paper-fluid-1 --carry asperity_friction
carrying=$(grep -oE 'screen --campaign [0-9]+' "$folder/out" | grep -oE '[0-9]+$')
printf '%s\n' name,relaxation_time_seconds,asperity_friction C,6e-7,3 >"$table"
expect 0 campaigns append "$carrying" "$table"
expect 2 campaigns append "$campaign" "$table"
err_has "column 'asperity_friction' is no parameter \(is asperity_friction_coefficient meant\?\) and no column of the campaign"
! grep -q -e --carry "$folder/err" || fail 'campaigns append suggests --carry, a flag of screen'
expect 0 screen --campaign "$carrying"
out_has 'best of 3 candidates'
expect 0 campaigns promote "$campaign" --candidate 7 --lubricant promoted-oil
out_has 'created lubricants/promoted-oil'
expect 1 campaigns promote "$campaign" --candidate 7 --lubricant promoted-oil
err_has 'lubricants/promoted-oil exists already'
expect 0 campaigns pause "$campaign"
err_has 'had already ended'
expect 1 campaigns resume "$campaign"
expect 2 campaigns show
expect 1 campaigns show 99999
{
  echo relaxation_time_seconds
  seq 60000 | sed 's/$/e-11/'
} >"$table"
expect 1 screen "$table" --like paper-fluid-1 --speeds 20,60,80 --budget-points 3000 --no-uncertainty
err_has 'is paused after [0-9]+ of 180000 points'
out_has 'not computed'
campaign=$(grep -oE 'campaigns/[0-9]+' "$folder/err" | head -n 1 | grep -oE '[0-9]+$')
"$client" screen "$table" --like paper-fluid-1 --speeds 20,60,80 --no-uncertainty --progress lines \
  >"$folder/out" 2>"$folder/err" </dev/null &
screening=$!
asked="screen, then Ctrl-C"
for _ in $(seq 600); do
  grep -q 'running' "$folder/err" && break
  sleep 0.05
done
kill -INT "$screening"
code=0
wait "$screening" || code=$?
[ "$code" -eq 130 ] || fail "an interrupted screening ends with exit code $code"
err_has "resumes campaigns/$campaign after [0-9]+ of 180000 points"
err_has "tribodyn screen --campaign $campaign"
kill -9 "$server_pid"
wait "$server_pid" 2>/dev/null
start_server
expect 0 campaigns pause "$campaign"
out_has "^$campaign +paused"
expect 0 campaigns resume "$campaign" --points 20000
expect 0 campaigns cancel "$campaign"
expect 1 screen "$table" --like paper-fluid-1 --speeds 20,60,80 --no-uncertainty
err_has "campaigns/$campaign is cancelled"
err_has "tribodyn campaigns delete $campaign"
expect 0 campaigns delete "$campaign"
expect 1 campaigns delete "$campaign"
expect 0 campaigns delete "$campaign" --allow-missing

expect 0 sensitivities paper-fluid-1 --speed 100
out_has 'lubricant pressure viscosity coefficient .*\|#'
expect 0 sensitivities paper-fluid-1 --speed 100 --output csv
out_has '^parameter,unit,value,derivative.inefficiency_rms_percent,elasticity.inefficiency_rms_percent'
expect 0 sensitivities paper-fluid-1 --speed 75
out_has 'lubricant pressure viscosity coefficient .*\|#'
expect 0 point --lubricant paper-fluid-1 --speed 100 --sensitivities
out_has '^Sensitivities'
expect 0 curve --lubricant paper-fluid-1 --speeds 60,100 --sensitivities --no-uncertainty --csv "$folder/slopes.csv"
out_has '^Sensitivities of the inefficiency'
out_has '^ *lubricant pressure viscosity coefficient +-?[0-9.]+ +-?[0-9.]+$'
head -1 "$folder/slopes.csv" | grep -q ',elasticity.film_ratio.mean.wheel_torque,' || fail "tribodyn curve --csv: no sensitivities"

echo "--- screening on a rig in place of the axle"
{
  echo "name,pressure-viscosity (1/GPa),asperity_friction_coefficient,cost"
  for i in $(seq 24); do echo "oil $i,$((14 + i % 5)),0.0$((80 + i % 7)),$((30 - i))"; done
} >"$table"
expect 0 screen "$table" --like paper-fluid-1 --rig traction --surface run-in --srr 2,10,50 --temperature 40,100 \
  --pareto cost --effects --uncertainty pressure-viscosity=3% --csv "$folder/rig.csv"
out_has '^ *rank +candidate +name +traction_coefficient'
out_has '20 of 24 candidates'
out_has 'No other candidate is better in both'
out_has 'Effects on traction_coefficient over 24 candidates'
on_rig=$(grep -oE 'campaigns/[0-9]+' "$folder/out" | head -n 1 | grep -oE '[0-9]+$')
[ "$(wc -l <"$folder/rig.csv")" -eq 145 ] || fail "a row for each of 24 candidates at 6 conditions"
head -n 1 "$folder/rig.csv" | grep -q '^name,candidate,.*,cost,load_newtons,.*,traction_coefficient,.*,refusal$' ||
  fail "the header of the rows of a rig"
expect 0 screen --campaign "$on_rig" --most central_film_thickness_metres:min --top 3
out_has '3 of 24 candidates'
out_has 'least central_film_thickness_metres'
expect 0 screen "$table" --like paper-fluid-1 --rig stribeck --output json
out_is_json
out_has '"ranking"'
cut -d , -f 1,2,4 "$table" >"$folder/smooth.csv"
expect 0 screen "$folder/smooth.csv" --like paper-fluid-1 --rig film --no-uncertainty
out_has 'central_film_thickness_metres'
on_film=$(grep -oE 'campaigns/[0-9]+' "$folder/out" | head -n 1 | grep -oE '[0-9]+$')
expect 0 campaigns show "$on_film"
out_has '24 candidates at 13 conditions of a rig'
out_has 'surface +none: smooth'
expect 0 screen "$folder/smooth.csv" --like paper-fluid-1 --no-uncertainty
on_axle=$(grep -oE 'campaigns/[0-9]+' "$folder/out" | head -n 1 | grep -oE '[0-9]+$')
expect 0 campaigns pareto "$on_axle" --most "$on_film/central_film_thickness_metres:min"
out_has "least central_film_thickness_metres of campaigns/$on_film"
expect 1 campaigns pareto "$on_axle" --least "$on_rig/traction_coefficient"
err_has "the candidates of campaigns/$on_rig are not those of campaigns/$on_axle"
expect 0 campaigns rank "$on_film" --where "$on_axle/inefficiency_energy_mean_percent<=100" --output csv
out_lines 21
expect 2 screen "$table" --like paper-fluid-1 --rig film --speeds 20 --vehicle passenger-car --plot x.svg --least a --most b
for part in '--speeds and --rig' '--vehicle and --rig' '--plot and --rig' 'give one --least or --most'; do err_has "$part"; done
expect 2 screen "$table" --like paper-fluid-1 --srr 10
err_has '--srr applies to a rig'
expect 1 screen "$table" --like paper-fluid-1 --rig traction --radius 0.001mm --load 1e9
err_has '--radius'

echo "--- curve"
expect 0 curve --lubricant sheet-a --speed 40,60 --plot "$folder/bands.svg"
out_has 'inefficiency +inefficiency +inefficiency'
out_has '\+/- 0\.[0-9]+ +\+/- 0\.0'
out_has '^Uncertainty of the inputs'
grep -q 'Bands: 95 % intervals' "$folder/bands.svg" || fail "the plot has no bands"
expect 0 curve --lubricant sheet-a --speeds 40,60 --sumps 40,90 --no-uncertainty --output csv
out_lines 5
expect 0 curve --lubricant paper-fluid-1 --speeds 20,100 --compare isothermal,no-boundary,down \
  --plot "$folder/variants.svg"
out_has 'difference %'
out_has '^ *20 +1\.3[0-9]+ +\+1[0-9]\.[0-9]{2} +-2[0-9]\.[0-9]{2}'
grep -q 'Difference of the energy mean' "$folder/variants.svg" || fail "the plot has no differences"
expect 0 curve --lubricant paper-fluid-1 --speeds 20,100 --plot "$folder/panels.svg" \
  --panels transmission-error,film-ratio
grep -q 'half backlash' "$folder/panels.svg" || fail "tribodyn curve: no half backlash in the plot"
expect 2 curve --lubricant paper-fluid-1 --panels film-ratio
err_has 'add --plot'
expect 2 curve --lubricant paper-fluid-1 --compare warmer
err_has "'warmer' must be one of"
expect 0 curve --lubricant sheet-a --speed 40,60 --no-uncertainty
out_lacks '^Uncertainty of the inputs'
expect 0 curve --lubricant paper-fluid-1 --lubricant paper-fluid-2,paper-fluid-3 --first-speed 40 --last-speed 60 --speed-step 10 \
  --model quasi-static --csv "$folder/curve.csv" --plot "$folder/curve.svg"
out_has 'lubricants/paper-fluid-3: inefficiency curve from 40 to 60 km/h'
head -1 "$folder/curve.csv" | grep -q ',estimated_relative_error,' || fail "curve.csv without errors"
[ "$(wc -l <"$folder/curve.csv")" -eq 10 ] || fail "curve.csv has not 1 + 9 lines"
grep -q '</svg>' "$folder/curve.svg" || fail "curve.svg is not whole"
if command -v rsvg-convert >/dev/null; then
  rsvg-convert "$folder/curve.svg" -o "$folder/curve.png" || fail "curve.svg cannot be drawn"
fi
expect 0 curve --lubricant paper-fluid-1 --first-speed 71 --last-speed 73 --speed-step 1 --model quasi-static
out_has 'error of 3 of the speeds is not estimated'
expect 0 curve --lubricant paper-fluid-1 --first-speed 40 --last-speed 60 --speed-step 10 \
  --model quasi-static --direction down --output csv
out_lines 4
out_has ',DOWN,'
expect 0 curve --lubricant paper-fluid-1 --first-speed 60 --last-speed 80 --speed-step 20 --independent-points
out_has 'from 60 to 80 km/h by 20, independent points'
out_has 'Each speed was solved independently'
expect 2 curve --lubricant paper-fluid-1 --independent-points --direction up
err_has 'either --direction or --independent-points'
expect 0 curve --lubricant paper-fluid-1 --first-speed 40 --last-speed 50 --speed-step 10 \
  --model quasi-static --output json
out_is_json
out_has '"simulations": \['
expect 2 curve --lubricant paper-fluid-1 --first-speed 40 --last-speed 50 --speed-step 10 \
  --model quasi-static --plot /nonexistent/folder/curve.svg
err_has 'cannot write /nonexistent/folder/curve.svg'
expect 2 curve --lubricant paper-fluid-1 --plot "$folder/curve.png"
err_has "Write --plot $folder/curve.svg"
expect 0 curve --lubricant paper-fluid-1 --speed 40,20m/s --sump -5C --model quasi-static \
  --plot "$folder/cold.svg"
out_has 'Cold inlet, do not rank oils here, at all'
out_has '^ +72 '
for part in 'do not rank oils here' 'COLD_INLET' 'tribodyn-model' 'hash of inputs [0-9a-f]{12}'; do
  grep -qE "$part" "$folder/cold.svg" || fail "cold.svg without '$part'"
done

echo "--- a torque far beyond the data of the gear set"
expect 0 point --lubricant paper-fluid-1 --model quasi-static --torque 765 --pinion-speed 200rad/s
head -1 "$folder/out" | grep -q '^! This pinion torque, 765 N m, is 7.[67] times what' ||
  fail "no word of the torque at the top"
out_has 'mesh loss +[0-9.]+ +kW'

echo "--- history"
expect 0 history --lubricant paper-fluid-1 --speed 50 --model quasi-static --mesh-cycles 2 \
  --samples-per-mesh-cycle 16 --columns mesh_force_newtons,flank_load_newtons --output csv \
  --plot "$folder/history.svg"
out_lines 33
out_is_csv
out_has '^time_seconds,mesh_force_newtons,flank_load_newtons_flank_0'
grep -q 'flank 2' "$folder/history.svg" || fail "history.svg misses a flank"
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
expect 0 jobs list --limit 2 --output csv
out_lines 3
expect 0 jobs list --limit 2 --output json
out_is_json

echo "--- Ctrl-C before the watch says what it leaves behind"
# interrupted_start PATTERN COMMAND...: interrupts the command while the server answers nothing.
interrupted_start() {
  local pattern=$1 code=0 pid
  shift
  asked="$*, then Ctrl-C at once"
  kill -STOP "$server_pid"
  "$client" "$@" >"$folder/out" 2>"$folder/err" </dev/null &
  pid=$!
  # Until SIGINT, the second lowest bit of the mask, is handled.
  for _ in $(seq 200); do
    grep -qE '^SigCgt:.*[2367abef]$' "/proc/$pid/status" && break
    sleep 0.05
  done
  sleep 0.3 # a call is under way
  kill -INT "$pid"
  wait "$pid" || code=$?
  kill -CONT "$server_pid"
  [ "$code" -eq 130 ] || fail "$asked: exit code $code, not 130"
  err_has "$pattern"
}
interrupted_start 'tribodyn: interrupted while simulations were submitted; `tribodyn jobs list` shows' \
  curve --lubricant paper-fluid-1,paper-fluid-2 --speeds 20,60
interrupted_start 'tribodyn: interrupted; nothing was submitted' \
  curve --lubricant paper-fluid-1 --speeds 20,60 --validate-only
interrupted_start 'tribodyn: interrupted; nothing was submitted' \
  screen --lubricants paper-fluid-1,paper-fluid-2 --speeds 20,60

echo "--- Ctrl-C stops the watch, not the job"
"$client" jobs watch "$job" --progress lines >"$folder/out" 2>"$folder/err" </dev/null &
watcher=$!
asked="jobs watch, then Ctrl-C"
for _ in $(seq 100); do
  grep -q running "$folder/err" && break
  sleep 0.1
done
kill -INT "$watcher"
code=0
wait "$watcher" || code=$?
[ "$code" -eq 130 ] || fail "Ctrl-C: exit code $code, not 130"
err_has "tribodyn jobs watch $job"
err_has "tribodyn jobs cancel $job"
expect 0 jobs get "$job"
out_has 'running'
expect 0 jobs cancel "$job"
expect 1 jobs watch "$job"
err_has 'cancelled'
expect 0 jobs cancel "$job"
err_has "simulations/$job had already ended \(cancelled\); nothing to cancel"
expect 0 jobs list --filter 'state = cancelled AND lubricant = paper-fluid-1'
out_has "^$job .*cancelled"
expect 0 jobs pin "$job"
out_has "^$job .* yes "
expect 0 jobs list --filter 'pinned = true' --output csv
out_lines 2
expect 0 jobs unpin "$job"
expect 0 jobs list --filter 'pinned = true' --output csv
out_lines 0
expect 1 jobs list --filter 'stat = cancelled'
err_has 'See tribodyn help filters'
expect 1 jobs wait "$job"
expect 1 jobs rerun none

echo "--- jobs are deleted for good, but neither while they run nor while they are pinned"
expect 0 jobs pin "$job"
expect 1 jobs delete "$job"
err_has 'is pinned; unpin it'
expect 0 jobs unpin "$job"
expect 0 jobs delete "$job"
err_has "^deleted simulations/$job\$"
expect 1 jobs delete "$job"
err_has "simulations/$job does not exist"
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
out_has '"cache_hit": false'
out_has '"lubricant": "lubricants/paper-fluid-2@1"'
expect 0 jobs wait "$name" --output csv
out_has 'SUCCEEDED'
expect 1 point --lubricant paper-fluid-2 --speed 51 --deadline-seconds 0.001 --method march
err_has 'DEADLINE_EXCEEDED|deadline_seconds'

echo "--- projects"
expect 1 --project axles lubricants list
err_has 'projects/axles does not exist'
stop_server
start_server --projects axles,gearboxes
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
err_has 'lower-case letters'

echo "--- results outlive the server"
expect 0 point --lubricant paper-fluid-3 --speed 50 --model quasi-static --output json
name=$(sed -n 's,^ "name": "simulations/\(.*\)".*,\1,p' "$folder/out")
cp "$folder/out" "$folder/before"
stop_server
expect 3 jobs get "$name"
start_server
expect 0 jobs get "$name" --output json
cmp -s "$folder/before" "$folder/out" || fail "the result of $name changed with a restart"

finish
