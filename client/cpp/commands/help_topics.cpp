#include "client/cpp/commands/help_topics.h"

namespace tribodyn::client {

const std::vector<HelpTopic>& help_topics() {
  static const std::vector<HelpTopic> kTopics = {
      {"units", "how to write numbers with their units",
       R"(Numbers with units

A flag for a quantity accepts a plain number in its own unit, which --help shows in angle brackets,
or a number with a unit, with or without a blank:
  --kv40 103           = --kv40 103mm2/s          --density15 868  = --density15 0.868g/cm3
  --sump 90            = --sump 90C               --speed 72.5     = --speed 20.14m/s
  --pressure-viscosity 20 = --pressure-viscosity 20/GPa
  --brookfield -40=98000  = --brookfield -40C=98Pas
If a flag's name ends in a unit, that unit is its own, as in JSON and CSV:
  --sump-temperature-celsius 90      --pressure-viscosity-coefficient-per-pascal 2e-8
A slope (--ascent) is an angle in degrees or percent: 3.4 or 6%. Numbers have a decimal point.

A unit is a product of powers of
  m g s K Pa N J W rad deg rpm St P bar l t h min %  with G M k d c m u n p before them
in any usual spelling: mm2/s = mm^2/s = cSt, mPas = mPa s = cP, 1/GPa = GPa^-1 = /GPa,
W/(m K) = W/mK = W/m/K, g/cm3 = kg/l. Temperatures are in C, K or F.

Tables print the units of data sheets (mm2/s, mPa s, 1/GPa, MPa, C, um). CSV and JSON have every
digit in the unit at the end of each name, mostly SI.
)"},
      {"screening", "tables of candidates that `tribodyn screen` reads",
       R"text(Screening

`tribodyn screen TABLE.csv --like LUBRICANT` evaluates variants of one lubricant, one a row, and
ranks them by their mesh inefficiency. The table is a CSV file as for import (`tribodyn help files`):
commas, semicolons or tabs, decimal points or commas, units in the header, in the second row or in a
cell. An empty cell leaves the value of the base.

  name, candidate or id: the candidates' names; without such a column they have the numbers 1, 2, ...
  Parameters of the lubricant and of the surface, by their names with or without their units:
    pressure_viscosity_coefficient, relaxation_time, limiting_shear_stress, ...;
    asperity_friction_coefficient, tribofilm_shear_strength, composite_rms_height, ...
    Boundary friction is that of the lubricant; of the surface only after "surface.". An empty cell
    of a lubricant that states none leaves that of the surface.
  Measurements of the lubricant: kv40, kv100, density15, "Brookfield -40 C", base_oil_class, ...:
    the server computes the parameters from them as it does for an import with --like. What it has to
    estimate from the class of base oil, such as the pressure-viscosity coefficient, has errors that
    a table cannot carry: such a table is refused. Import it (`tribodyn lubricants import FILE`) and
    screen the lubricants (--lubricants), or state these parameters in columns or in the base.
  FIELD.standard_uncertainty: of a parameter, each candidate's own.
  Any other column is carried along into the results: additive, treat rate, cost. If its name
    resembles that of a parameter, --carry NAME says that it is none. A number of a lubricant that is
    no parameter, such as the pour point, needs --carry too and has no effect: import lubricants with
    it and screen them (--lubricants).

  name,treat rate,pressure-viscosity (1/GPa),asperity_friction_coefficient
  A1,0.5,19.8,0.11
  A2,1.0,,0.09

`tribodyn design` makes such tables from ranges, or from the uncertainties of a lubricant. `tribodyn
screen --range PARAMETER=LOW:HIGH --count N` has the server make the same candidates and needs no table;
without a range they spread by the standard uncertainties of --like. `--lubricants A,B` and
`--lubricant-filter FILTER` screen lubricants that exist. `tribodyn campaigns append NAME more.csv` adds
candidates to a campaign.

A candidate with a value outside its range, or that the model refuses, is listed with the reason; the
others are ranked. --csv FILE and --jsonl FILE write every candidate at every condition.

The server computes the table as a campaign, of up to 100,000 candidates and 20 million points, and
keeps its figures (`tribodyn campaigns list`). The request id of the campaign is made of base,
candidates, conditions, weights and model: the same command finds its campaign, goes on after an
interruption of client or server, and reads what is computed. It resumes a campaign that is paused.
--budget-points and --budget-processor-seconds pause it when they are spent. `tribodyn screen
--campaign NAME` ranks a campaign without its table, with other --weights if they are stated, by the
candidates' parameters in the units of their fields.

--rig traction, film or stribeck runs the candidates on a ball on a disc in place of the axle, with the
defaults of these commands and their settings: --load, --srr, --temperature, --radius and others;
--entrainment-speed is their --speed. The candidates are ranked by least traction, on the rig for films
by the thickest film, or by --least FIGURE or --most FIGURE. Each is a campaign of its own: `tribodyn
campaigns pareto 12 --least 13/traction_coefficient` sets the loss of the axle in campaign 12 against the
traction of the same candidates in campaign 13.

Candidates cannot be told apart from the best one if the interval of the difference that has the
--confidence holds 0. Candidates with a warning that withholds the verdict stand last and are marked:
their figures decide nothing. Uncertainties of parameters in the table (--uncertainty, columns) are
each candidate's own; those of all other parameters, stated there or by the base, are common to all
candidates and nearly cancel.
)text"},
      {"columns", "names and units of the columns of results",
       R"(Columns of results

Each name ends in its unit, mostly SI: mesh_loss_power_watts, contact_temperature_kelvin; a name without
a unit is a pure number or a word. `tribodyn schema` lists every column at its end, with what it means,
and GetSchema returns the same to programs.

Points and curves (--output csv, curve --csv): one row for each speed, first the inputs, then every
figure of the result.
  inefficiency_energy_mean_percent   loss energy over the energy that comes in: the figure that
                                     compare, explain and screen rank by
  inefficiency_rms_percent           eq 30 over the power that comes in, root mean square over time
  viscous_loss_power_watts, boundary_loss_power_watts   the two parts of mesh_loss_power_watts
  minimum_, mean_, maximum_ before film_ratio, contact_temperature_kelvin, maximum_pressure_pascals,
    dynamic_transmission_error_metres, ...   over the steady state; of contacts over loaded flanks,
                                     means weighted with the load
  mean_friction_coefficient          of the mesh: friction over normal load of all flanks
  flank_losses_0_friction_coefficient to flank_losses_2_   the same of one flank slot
  minimum_, mean_, maximum_ before pinion_specific_sliding, gear_specific_sliding   sliding speed
                                     over the speed of the surface, without sign
  ... before flash_temperature_rise_kelvin   rise of the flanks' surfaces above the inlet
  limiting_stress_area_share         mean share of the contact area at the limiting shear stress
  estimated_relative_error           of inefficiencies, torque and transmission error, by the solver
  warnings                           codes of the warnings of the point, separated by blanks
Histories (--columns): one row for each sample; the last column has the codes of the warnings. Names
that begin with flank_ have a column for each slot: flank_load_newtons_flank_0 to _flank_2.
compare: FIGURE_value, FIGURE_standard_uncertainty (of the inputs), FIGURE_interval_minimum and
  _interval_maximum (95 %), FIGURE_linear_standard_uncertainty, FIGURE_solver_error;
  difference.verdict: LOWER, HIGHER, CANNOT_BE_TOLD_APART, WITHHELD (by a warning) or
  UNCERTAINTY_NOT_STATED, of which the last two have no probability; warnings.
explain: one row for each group of parameters; shapley_value is its share in the difference,
  first_effect and last_effect what it adds before and after all other groups.
)"},
      {"files", "what import, export and validate read and write; pictures in print",
       R"text(Files

A JSON file contains one resource, with the field names of the protos (snake_case or camelCase), or
a list of resources:
  {"name": "lubricants/my-oil", "measurements": {
     "kinematic_viscosity_40_celsius_square_millimetres_per_second": 73.3, ...}}
  {"lubricants": [ ... ]}
A misspelt name is an error that names the nearest field. `export` writes such files; `import`,
`create --file`, `update --file` and `validate` read them; "-" is standard input.

Tables are CSV with a header; columns may be in any order, their names in upper or lower case. File
names end in .csv, .tsv, .tab or .txt; the encoding is UTF-8, UTF-16 or Latin-1. Excel workbooks are
rejected. Commas, semicolons or tabs separate cells. Numbers have a decimal point, or a decimal
comma if commas do not separate the cells. Lines that begin with # are skipped.
  Viscosities (lubricants): temperature_celsius or temperature_kelvin; and one or more of
    kinematic_viscosity_square_millimetres_per_second, dynamic_viscosity_millipascal_seconds,
    dynamic_viscosity_pascal_seconds, density_kilograms_per_cubic_metre,
    density_grams_per_cubic_centimetre; if known relative_standard_uncertainty, of the viscosities.
    Empty cells are skipped. A header may also be a name with its unit: "T (C)", "KV (mm2/s)",
    "Viscosity (mPa s)", "Density (g/cm3)".
      temperature_celsius,kinematic_viscosity_square_millimetres_per_second
      20,200
      40,73.3
      100,8.86
  One lubricant, surface or vehicle per row: these tables have a column "name". The other columns
    have the field names of JSON, those of measurements included, or names of data sheets: kv40,
    kv100, kv100-sheared, density15, "base oil", "density 15 C". A header may have a unit in
    brackets, "Density15 (g/cm3)"; the second row may contain units; a cell may have its own unit,
    "20/GPa". labels.KEY is a label.
    FIELD.provenance, FIELD.source, FIELD.standard_uncertainty and FIELD.warning are the origin of a
    number. Classes of base oil may have any usual spelling: PAO, Gr. III, Ester. Brookfield
    viscosities are in columns "Brookfield -40 C", in mPa s, or in one cell of a column
    brookfield_viscosities: "150000 mPa s at -40 C; 21000 mPa s at -26 C". Columns viscosities and
    densities have the same form: "205 mm2/s at 20 C +- 0.01" has a relative standard uncertainty.
    Empty cells set nothing; with --like their values come from that resource. `export --all
    --output csv` writes such a table of measured and stated values; an import computes the others
    from the table.
      name,kv40,kv100,base_oil_class,labels.project
      my-oil,73.3,8.86,group-iii,axle
  Tooth contact (gear sets): roll_pitches, pinion_roll_radians or pinion_roll_degrees (one pair from
    -1.5 to 1.5 pitches), or mesh_phase and slot; then load_share, radius_x_metres, radius_y_metres,
    pinion_velocity_x_metres, pinion_velocity_y_metres, gear_velocity_x_metres,
    gear_velocity_y_metres; if known contact_point_velocity_x_metres,
    contact_point_velocity_y_metres, pinion_friction_arm_metres, gear_friction_arm_metres. Each
    length also in _millimetres.
  Series (gear sets): quantity, harmonic, sine, cosine; the cosine of harmonic 0 is the mean.
    Quantities: pinion_contact_radius_metres, gear_contact_radius_metres,
    mesh_stiffness_newtons_per_metre, static_transmission_error_metres.
  Profiles (surfaces): position and height, each in _metres, _millimetres or _micrometres, height
    also in _nanometres, or with the headers of instruments: "X (mm)", "Z (um)"; positions must be
    evenly spaced.
The errors of a file are listed with row and column, or with their place in the list. An error that
many rows share is listed once, with the number of rows.

An import reads any number of files and writes all of their resources or none, also if it is
interrupted or the server is lost. A resource may be derived from another one of the same import, in
any order. A name that exists is an error; with --replace the resource gets a new revision if
anything differs, and a table changes only the fields of its columns. At most 20000 resources and
64 MiB per import.

Pictures (--plot) are SVG, which has no fixed size and whose texts remain texts: any drawing program
changes their fonts and titles. For print, with librsvg2-bin of Debian:
  rsvg-convert --format pdf --width 1200 --keep-aspect-ratio curve.svg > curve.pdf
)text"},
      {"filters", "which resources a list shows, and in which order",
       R"(Filters of lists

  tribodyn lubricants list --filter 'kv100 > 13.5 AND vi > 150' --order-by kv40
  tribodyn lubricants list --filter 'labels.project = "axle" AND condition = sheared'
  tribodyn lubricants list --filter 'pressure_viscosity_coefficient_per_pascal > 1.5e-8'
  tribodyn lubricants list --label project=axle --order-by 'create_time desc' --limit 20
  tribodyn jobs list --filter 'state = failed AND lubricant = castrol-75w90'
  tribodyn jobs list --label project=axle --filter 'create_time > 2026-01-31T12:00:00Z'

AND joins restrictions. Operators: = != < <= > >= and ":" (contains; `labels.key:*` matches any
value). Put texts with blanks in double quotes. Numbers are in the unit of the field's name; kv40,
kv100 (mm2/s), vi, sae_grade and density (kg/m3, at 15 C) are the columns of a list of lubricants.
Names may have their collection, states and classes may be in upper or lower case.
`tribodyn schema` lists the fields under "lubricants.filter" and so on. Jobs and campaigns have
state, lubricant (my-oil, or my-oil@2 for a revision), gear_set, surface, vehicle, display_name,
create_time, end_time, input_hash and labels; jobs also have pinned (true or false).
)"},
      {"models", "what the choices of the model are worth",
       R"text(Choices of the model

A figure errs by the solver, by its inputs and by the model. The solver's error has a column or a line
of its own. What the inputs leave open, from the uncertainties that lubricant and surface state, is the
95 % interval: "+/-" and bands mean this everywhere. The error of the model is in neither, and only
measurements of an axle could state it.

Two presets (--model-preset):
  recommended   the default. The paper's model with its misprints corrected, and two departures:
                --inlet-shear-heating: the film is thinner where oil heats up by shear in front of the
                contact (Gupta and others 1992). Films measured on a rig at 1 to 3 m/s lie 13 % below
                the film without it and 4 % below the film with it. Thick and cold oils lose much of
                their film by it: without it they win where they should not.
                --closed-load-sharing: asperities carry what the film no longer can, so that friction
                tends to boundary friction where the film vanishes. In eq 41 alone a smooth surface's
                asperities carry 3 % at most, and Stribeck curves fall towards low speed. Above a film
                ratio of 1.5 it changes figures by less than 1 %.
  paper         without both, as the paper: for whoever compares with it. `tribodyn paper` always uses
                it.
=false switches one of the two off: --inlet-shear-heating=false. A warning that withholds the verdict
stands where a film without inlet heating would be wrong by more than 5 %.

What each choice is worth can be computed: `curve --compare` computes your curve also with the other
choice. Of a population of 23 oils on the default axle, surface and vehicle at a sump of 40 C the
mean inefficiency then changes, in percent of it, by (median; least to largest)

                                 20                    60                    100 km/h
Without a departure of the preset
  no-inlet-shear-heating         -3.3 (-6.5 to -1.5)   -6.7 (-27 to -4.5)    -13 (-32 to -8.7)
  no-closed-load-sharing         -26 (-78 to +0.0)     +0.0 (-50 to +0.0)    +0.0 (-10 to +0.0)
  paper                          -26 (-78 to -1.5)     -6.7 (-54 to -4.5)    -13 (-32 to -8.7)
Another law or approximation
  exact-hertz                    +0.4 (-0.1 to +1.3)   +0.5 (+0.1 to +0.9)   +0.3 (+0.0 to +0.7)
  hertz-from-total-load          +2.2 (+0.3 to +2.8)   +0.6 (+0.0 to +2.0)   +0.2 (+0.0 to +1.4)
  subtract-contact-point-motion  -23 (-40 to -4.2)     -7.6 (-44 to -4.2)    -5.4 (-21 to -0.7)
  load-dependent-mesh-data       +1.7 (+0.2 to +4.7)   +0.2 (+0.0 to +0.9)   -0.7 (-1.6 to -0.2)
  houpert                        -12 (-48 to -2.1)     -22 (-49 to -4.1)     -23 (-48 to -5.2)
An effect left out
  isothermal                     +11 (+1.4 to +15)     +30 (+14 to +80)      +48 (+30 to +161)
  newtonian                      +3.0 (+0.3 to +24)    +4.9 (+1.1 to +20)    +4.2 (+0.8 to +19)
  no-limiting-shear-stress       +1.7 (+0.0 to +71)    +9.3 (+0.0 to +31)    +5.2 (+0.0 to +17)
  no-boundary-friction           -44 (-96 to -0.9)     -2.8 (-69 to +0.0)    -1.1 (-26 to +0.0)

houpert estimates the growth of viscosity with pressure instead of using the measured coefficient.
damping-in-contact-only, energy-consistent and tabulated-friction-arms change less than
0.05 % here.
Whether a choice turns the order of two lubricants over, only their own curves say:
  tribodyn curve --lubricant A,B --speeds 20,60,100 --compare exact-hertz,no-inlet-shear-heating
)text"},
      {"configuration", "configuration file and environment",
       R"(Configuration

A flag overrides the environment, the environment overrides the file.
  file:         $XDG_CONFIG_HOME/tribodyn/config, else ~/.config/tribodyn/config;
                TRIBODYN_CONFIG names another file
  environment:  TRIBODYN_SERVER, TRIBODYN_PROJECT, TRIBODYN_TOKEN_FILE, TRIBODYN_CA_FILE,
                TRIBODYN_CERTIFICATE_FILE, TRIBODYN_KEY_FILE, TRIBODYN_TIMEOUT_SECONDS,
                TRIBODYN_OUTPUT, TRIBODYN_PROGRESS, TRIBODYN_COLOR; NO_COLOR turns colours off

The file sets flags that every command has, one per line, without their dashes:
  # the plant's server
  server = tribodyn.example.com:50651
  ca-file = /home/anna/.config/tribodyn/ca.pem
  project = default
  token-file = /home/anna/.config/tribodyn/token
  timeout-seconds = 60
  output = table
  progress = auto
  color = auto
)"},
      {"options", "options of all commands",
       R"(Options of every command

  --server HOST:PORT   address of the server (the socket of your own tribodynd, or
                       127.0.0.1:50651); unix:PATH for a Unix socket
  --project NAME       project of the resources and jobs (default)
  --token-file FILE    file with the token for the server
  --ca-file FILE       who signs the server's certificate (TLS, for addresses beyond loopback)
  --certificate-file, --key-file FILE  your own, for a server that requires one
  --timeout-seconds S  time limit of one call (30)
  --output, -o FORM    table for people, csv and json for programs
  --progress FORM      auto (bars, only on a terminal), lines (for a log) or none
  --color WHEN         auto, always or never; --no-color

Results go to standard output, progress and errors to standard error. Commands never start a pager
or prompt for input. An option may be before or after the command; --name=value means --name value.
Names of resources may include their collection: my-oil or lubricants/my-oil; my-oil@2 is revision
2 of it. `tribodyn completion bash` completes commands, options and names.
)"},
      {"exit-codes", "exit codes for scripts",
       R"(Exit codes

    0  done
    1  the server rejected the request, or a simulation failed or was cancelled
    2  an error in the command line, the configuration or a file; nothing was sent
    3  no server at the address, or no answer in time
    4  diff --exit-code: the fluids differ
  130  interrupted (Ctrl-C); simulations go on, and the commands to watch or cancel them are printed

A command prints all errors of a kind together, on standard error.
)"},
  };
  return kTopics;
}

}  // namespace tribodyn::client
