#include "client/cpp/commands/help_topics.h"

namespace tribodyn::client {

const std::vector<HelpTopic>& help_topics() {
  static const std::vector<HelpTopic> kTopics = {
      {"units", "how to write numbers with their units",
       R"(Numbers with units

Every flag that takes a quantity takes a plain number in its own unit, which --help shows in angle
brackets, or a number with a unit, with or without a blank:
  --kv40 103           = --kv40 103mm2/s          --density15 868  = --density15 0.868g/cm3
  --sump 90            = --sump 90C               --speed 72.5     = --speed 20.14m/s
  --pressure-viscosity 20 = --pressure-viscosity 20/GPa
  --brookfield -40=98000  = --brookfield -40C=98Pas
Where a flag's name ends in a unit, that is its own unit, as it is in JSON and CSV:
  --sump-temperature-celsius 90      --pressure-viscosity-coefficient-per-pascal 2e-8
A slope (--ascent) is an angle in degrees or percent: 3.4 or 6%. Numbers have a decimal point.

Understood are products of powers of
  m g s K Pa N J W rad deg rpm St P bar l t h min %  with G M k d c m u n p before them
in any usual spelling: mm2/s = mm^2/s = cSt, mPas = mPa s = cP, 1/GPa = GPa^-1 = /GPa,
W/(m K) = W/mK = W/m/K, g/cm3 = kg/l. Temperatures are in C, K or F.

Printed are the units of the trade (mm2/s, mPa s, 1/GPa, MPa, C, um). CSV and JSON are in the unit
that ends each name, SI as a rule, every digit kept.
)"},
      {"files", "what import, export and validate read and write",
       R"text(Files

JSON holds a resource as the protos name its fields (snake_case or camelCase), or a list of them:
  {"name": "lubricants/my-oil", "measurements": {
     "kinematic_viscosity_40_celsius_square_millimetres_per_second": 73.3, ...}}
  {"lubricants": [ ... ]}
A misspelt name is refused, and the one that may be meant is named. `export` writes it, `import`,
`create --file`, `update --file` and `validate` read it; "-" is standard input.

Tables are CSV with a header; the order of columns is free, their names may be in any case. Files
end in .csv, .tsv, .tab or .txt; UTF-8, UTF-16 and Latin-1 are read, Excel workbooks are not. Cells
are separated by commas, semicolons or tabs. Numbers have a decimal point, or a decimal comma where
commas do not separate the cells. Lines that begin with # are skipped.
  Viscosities (lubricants): temperature_celsius or temperature_kelvin; and one or more of
    kinematic_viscosity_square_millimetres_per_second, dynamic_viscosity_millipascal_seconds,
    dynamic_viscosity_pascal_seconds, density_kilograms_per_cubic_metre,
    density_grams_per_cubic_centimetre; if known relative_standard_uncertainty, of the viscosities.
    Empty cells are left out. A header may also be a name with its unit: "T (C)", "KV (mm2/s)",
    "Viscosity (mPa s)", "Density (g/cm3)".
      temperature_celsius,kinematic_viscosity_square_millimetres_per_second
      20,200
      40,73.3
      100,8.86
  One lubricant, surface or vehicle a row: a column "name" makes a table one of these. The other
    columns are fields as JSON names them, those of measurements too, or as the trade does: kv40,
    kv100, kv100-sheared, density15; with a unit in brackets, "Density15 (g/cm3)", or units in the
    second row. A cell may hold its unit itself, "20/GPa". labels.KEY is a label. FIELD.provenance,
    FIELD.source, FIELD.standard_uncertainty and FIELD.warning tell how a number is known. Classes
    of base oil are read in any usual spelling: PAO, Gr. III, Ester. Brookfield viscosities are in
    columns "Brookfield -40 C", in mPa s, or in one cell of a column brookfield_viscosities:
    "150000 mPa s at -40 C; 21000 mPa s at -26 C". Columns viscosities and densities are written
    likewise: "205 mm2/s at 20 C +- 0.01" has a relative standard uncertainty. Empty cells are not
    set; with --like they are as in that resource. `export --all --output csv` writes such a table
    of what was measured and stated; an import computes the rest again, from changed cells too.
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
    also in _nanometres, or as instruments head them: "X (mm)", "Z (um)"; positions evenly spaced.
Every violation is named with its row and column, or with its place in the list; the same one in
many rows is told once, with their number.

An import takes any number of files and writes all that they hold or nothing: not when one of them
is wrong, nor when it is interrupted or the server is lost on the way. One may be derived from
another one in any order. Names that are taken are refused, or with --replace get a new revision
where anything differs; a table changes only what its columns tell of. At most 20000 resources and
64 MiB at once.
)text"},
      {"filters", "which resources a list shows, and in which order",
       R"(Filters of lists

  tribodyn lubricants list --filter 'kv100 > 13.5 AND vi > 150' --order-by kv40
  tribodyn lubricants list --filter 'labels.project = "axle" AND condition = sheared'
  tribodyn lubricants list --filter 'pressure_viscosity_coefficient_per_pascal > 1.5e-8'
  tribodyn lubricants list --label project=axle --order-by 'create_time desc' --limit 20
  tribodyn jobs list --filter 'state = failed AND lubricant = castrol-75w90'
  tribodyn jobs list --label project=axle --filter 'create_time > 2026-01-31T12:00:00Z'

Restrictions are joined by AND. Operators: = != < <= > >= and ":" (contains; `labels.key:*` means:
is there). Texts with blanks stand in double quotes. Numbers are in the unit of the field's name;
kv40, kv100 (mm2/s), vi, sae_grade and density (kg/m3, at 15 C) are the figures that a list of
lubricants shows. Names stand with or without their collection, states and classes in either case.
`tribodyn schema` lists the fields under "lubricants.filter" and so on. Jobs have state, lubricant
(1, or 1@2 for a revision), pinned (true or false), create_time and labels.
)"},
      {"configuration", "configuration file and environment",
       R"(Configuration

A flag wins over the environment, the environment over the file.
  file:         $XDG_CONFIG_HOME/tribodyn/config, else ~/.config/tribodyn/config;
                TRIBODYN_CONFIG names another one
  environment:  TRIBODYN_SERVER, TRIBODYN_TIMEOUT_SECONDS, TRIBODYN_OUTPUT, TRIBODYN_PROGRESS,
                TRIBODYN_COLOR; NO_COLOR turns colours off

The file holds the flags that every command has, one a line, without dashes in front:
  # the plant's server
  server = 127.0.0.1:50651
  timeout-seconds = 60
  output = table
  progress = auto
  color = auto
)"},
      {"options", "what is common to all commands",
       R"(Options of every command

  --server HOST:PORT   another server than 127.0.0.1:50651; unix:PATH for a socket
  --timeout-seconds S  longest wait for one answer (30)
  --output, -o FORM    table for people, csv and json for programs
  --progress FORM      bars on a terminal and nothing elsewhere (auto), lines for a log, or none
  --color WHEN         auto, always or never; --no-color

Results go to standard output, progress and errors to standard error. No pager is started and
nothing is asked. An option may stand before or after the command; --name=value is --name value.
Names of resources may be given with or without their collection: 1 or lubricants/1; 1@2 is
revision 2. `tribodyn completion bash` completes commands, options and names.
)"},
      {"exit-codes", "what scripts can rely on",
       R"(Exit codes

    0  done
    1  the server refused, or a simulation failed or was cancelled
    2  the command line, the configuration or a file is wrong; nothing was sent
    3  no server at the address, or no answer in time
    4  diff --exit-code: the fluids differ
  130  interrupted (Ctrl-C); simulations go on, and the way to follow or cancel them is printed

All complaints of a kind come at once, on standard error.
)"},
  };
  return kTopics;
}

}  // namespace tribodyn::client
