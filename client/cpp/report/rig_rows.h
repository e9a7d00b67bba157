#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/cpp/text/output.h"
#include "client/cpp/text/warnings.h"
#include "tribodyn/v1/rigs.pb.h"

namespace tribodyn::client {

/// What one rig command shows: its name, and the figure against what the machine sweeps.
struct RigView {
  const char* command;  ///< "traction"
  const char* title;
  const char* x;  ///< field of RigCondition
  const char* y;  ///< column of EvaluateRigResponse
  const char* x_title;
  const char* y_title;
  double y_factor;      ///< from the column's unit to that of y_title
  bool is_logarithmic;  ///< both axes
};

/// What the stated uncertainties of the inputs make of a figure, in its unit; NaN if the model
/// refused too many draws.
struct RigBand {
  double standard_uncertainty, interval_minimum, interval_maximum;
};

/// One condition with its figures.
struct RigRow {
  std::string fluid;  ///< revision, e.g. "lubricants/paper-fluid-1@1"
  bool is_isothermal = false;
  v1::RigCondition condition;
  std::map<std::string, double> figures;  ///< by column; empty for a refused row
  std::string refusal;                    ///< why not; empty: none
  std::map<std::string, RigBand> bands;   ///< by column, of figures that the draws move
  int refused_draws = 0;
  std::vector<ShownWarning> warnings = {};
  std::optional<double> measured;  ///< of the view's y, in the unit of its column
};

/// How the bands of the rows came about.
struct RigDraws {
  int draws = 0;  ///< of the inputs; 0: no bands
  /// By fluid (as in RigRow): inputs that count as exact.
  std::map<std::string, std::vector<std::string>> exact_inputs;
};

/// Returns the columns of figures of an answer, in the order of its fields.
const std::vector<std::string>& rig_columns();

/// Returns the warnings of the rows with the fluids and places of the view's x that have them.
std::vector<ShownWarning> rig_warnings(const std::vector<RigRow>& rows, const RigView& view);

/// Returns the rows of an answer; `measured` is empty or holds a value for each condition.
std::vector<RigRow> rig_rows(const v1::EvaluateRigRequest& request,
                             const v1::EvaluateRigResponse& answer,
                             const std::vector<std::optional<double>>& measured);

/// Returns (computed - measured)/measured in percent; nullopt without either.
std::optional<double> residual_percent(const RigRow& row, const RigView& view);

/// Returns the rows in one of the forms of --output. JSON is an object whose "rows" are objects
/// with the headers of CSV. A table has the 95 % interval of the view's y; below it stand what is
/// behind that, the RMS residual of each fluid if anything was measured, and the warnings.
std::string rig_text(const std::vector<RigRow>& rows, const RigView& view, OutputFormat format,
                     const RigDraws& draws = {});

/// Returns the condition and measured value of each line of a CSV: columns of the view's x and y,
/// by the names of their fields; others of RigCondition are optional and otherwise those of
/// `usual`. Throws Failure, naming `path`, line and column, if the text is not such a table.
struct MeasuredPoint {
  v1::RigCondition condition;
  double value;
};
std::vector<MeasuredPoint> read_measured(const std::string& text, const std::string& path,
                                         const RigView& view, const v1::RigCondition& usual);

/// Draws a line for each fluid, load, temperature, and speed or slide-roll ratio that is not swept;
/// isothermal lines are dashed, measured points hollow, 95 % intervals translucent bands.
std::string rig_plot(const std::vector<RigRow>& rows, const RigView& view,
                     const std::string& model_version);

}  // namespace tribodyn::client
