#pragma once
/// Metrics as JSON.

#include <string>
#include <utility>
#include <vector>

#include "plumb/slam/values.hpp"

namespace plumb::write_metrics {

/// {"stages": [{"stage": label, "numbers": {name: {"value", "unit"}}, "notes": [...], "edges":
/// [{...}, ...]}, ...]}, in the order given; an edge a line: i, j, kind, found, kept, residual [m],
/// weight, status. Numbers are the shortest that read back as the same; one that is non-finite
/// is null. The same metrics give the same bytes.
std::string metrics_json(const std::vector<std::pair<std::string, const Metrics*>>& stages);

}  // namespace plumb::write_metrics
