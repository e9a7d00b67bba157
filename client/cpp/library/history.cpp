#include "client/cpp/library/column_stream.h"
#include "client/cpp/library/services.h"

namespace tribodyn::client {

void Connection::stream_history(const std::string& name, const HistoryOptions& options,
                                const std::function<void(const v1::HistorySchema&)>& on_schema,
                                const std::function<void(const HistoryRows&)>& on_rows) {
  v1::ReadHistoryRequest request;
  request.set_name(name);
  add_project(services_->project, request);
  *request.mutable_columns() = {options.columns.begin(), options.columns.end()};
  request.set_start_row(options.start_row);
  request.set_row_count(options.row_count);
  request.set_max_points(options.maximum_points);
  stream_columns<v1::ReadHistoryResponse>(*services_, *services_->simulations,
                                          &v1::SimulationService::Stub::ReadHistory, request,
                                          on_schema, on_rows);
}

v1::History Connection::read_history(const std::string& name, const HistoryOptions& options) {
  v1::History out;
  stream_history(
      name, options,
      [&out](const v1::HistorySchema& schema) {
        out.set_start_row(schema.start_row());
        out.set_total_rows(schema.total_rows());
        out.set_rows_per_pair(schema.rows_per_pair());
        *out.mutable_input_warnings() = schema.input_warnings();
        for (const auto& each : schema.columns()) {
          v1::History::Column* column = out.add_columns();
          column->set_name(each.name());
          column->set_unit(each.unit());
        }
      },
      [&out](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.size(); ++i) {
          out.mutable_columns(static_cast<int>(i))
              ->mutable_values()
              ->Add(rows.columns[i].begin(), rows.columns[i].end());
        }
      });
  return out;
}

}  // namespace tribodyn::client
