#include "verdict.hpp"

#include "parts.hpp"

namespace plumb::solve_pose_graph {

const char* status_of(double mean_weight) {
  return mean_weight >= accepted_from    ? "accepted"
         : mean_weight >= rejected_under ? "down-weighted"
                                         : "rejected";
}

void Verdict::add(const EdgeState& state) {
  const auto& e = state.edge();
  const auto pairs = static_cast<std::uint32_t>(state.pairs());
  EdgeRecord record{e.i, e.j, e.kind, state.found(), pairs, 0, 0, "no matches"};
  if (pairs > 0) {
    record.residual = state.rms();
    record.weight = state.mean_weight();
    record.status = status_of(record.weight);
    pairs_ += pairs;
    squares_ += state.weighted_squares();
    weights_ += state.weight_sum();
    support_[e.i] += state.weight_sum();
    support_[e.j] += state.weight_sum();
  }
  records_.push_back(std::move(record));
}

void Verdict::add(const RelativePose& r, bool sequential, double residual, double weight) {
  const auto kind = sequential ? EdgeKind::sequential : EdgeKind::loop;
  records_.push_back({r.i, r.j, kind, 1, 1, residual, weight, status_of(weight)});
  squares_ += weight * residual * residual;
  weights_ += weight;
  constraints_ = true;
}

Metrics Verdict::metrics(double cost_before, double cost_after, int rounds, int iterations) {
  const auto with_status = [&](std::string_view status) {
    return static_cast<double>(std::count_if(records_.begin(), records_.end(),
                                             [&](const auto& r) { return r.status == status; }));
  };
  Metrics metrics;
  metrics.add("residual", weights_ > 0 ? std::sqrt(squares_ / weights_) : 0, "m")
      .add("cost_before", cost_before, "")
      .add("cost_after", cost_after, "")
      .add("pairs", static_cast<double>(pairs_), "")
      .add("edges", static_cast<double>(records_.size()), "")
      .add("edges_kept", with_status("accepted"), "")
      .add("edges_down_weighted", with_status("down-weighted"), "")
      .add("edges_rejected", with_status("rejected"), "")
      .add("edges_without_matches", with_status("no matches"), "")
      .add("rounds", rounds, "")
      .add("iterations", iterations, "");
  metrics.notes = notes();
  metrics.edges = std::move(records_);
  return metrics;
}

void Verdict::drop_left_out(std::vector<std::vector<std::uint32_t>>& parts) const {
  std::erase_if(parts, [&](const auto& part) {
    return part.size() == 1 && std::binary_search(left_out_.begin(), left_out_.end(), part.front());
  });
}

std::vector<std::string> Verdict::notes() const {
  std::vector<std::string> notes;
  Parts firm(support_.size());
  for (const auto& r : records_)
    if (r.status == "accepted" || r.status == "down-weighted") firm.join(r.i, r.j);
  auto parts = firm.list();
  drop_left_out(parts);
  if (!left_out_.empty())
    notes.push_back("segments " + runs_of(left_out_) +
                    " are named by no constraint and keep their place after the one before");
  if (prior_ && parts.size() > 1) {
    std::string sentence = "the graph falls into " + std::to_string(parts.size()) +
                           " parts that only the odometry joins (segments ";
    for (std::size_t n = 0; n < std::min<std::size_t>(parts.size(), 6); ++n)
      sentence += (n ? "; " : "") + runs_of(parts[n]);
    notes.push_back(sentence + (parts.size() > 6 ? "; and more)" : ")"));
  }
  for (std::size_t n = 1; n < parts.size() && !prior_; ++n)
    notes.push_back("segments " + runs_of(parts[n]) +
                    " are not joined to the rest by any accepted edge");
  if (constraints_) return notes;
  std::vector<std::uint32_t> weak;
  for (std::uint32_t v = 0; v < support_.size(); ++v)
    if (support_[v] < 10) weak.push_back(v);
  if (!weak.empty())
    notes.push_back("segments " + runs_of(weak) + " are held by fewer than 10 pairs each");
  return notes;
}

std::vector<std::string> Verdict::warnings(std::vector<std::vector<std::uint32_t>> parts) const {
  drop_left_out(parts);
  if (parts.size() < 2) return {};
  std::string sentence =
      "the graph falls into " + std::to_string(parts.size()) + " parts (segments ";
  for (std::size_t n = 0; n < parts.size(); ++n) {
    if (n == 6 && parts.size() > 7) {
      sentence += "; and " + std::to_string(parts.size() - n) + " more";
      break;
    }
    sentence += (n ? "; " : "") + runs_of(parts[n]);
  }
  return {sentence +
          "), which no edge with pairs joins: each is solved by itself and keeps its place "
          "after the segment before it; give more edges, or odometry_translation_sigma and "
          "odometry_rotation_sigma"};
}

}  // namespace plumb::solve_pose_graph
