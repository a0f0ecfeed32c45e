/// plumb evaluate: a trajectory against the sequence's truth.

#include <iostream>
#include <memory>

#include "command.hpp"
#include "command_line.hpp"
#include "plumb/slam/report/evaluation.hpp"

namespace plumb::command {

void add_evaluate(Command& program) {
  struct Options {
    EvaluationInput input;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  Command command = program.add_subcommand(
      "evaluate", "Judges a trajectory by the sequence's truth, before and after");
  command
      .add_option("sequence", options->input.sequence,
                  "Folder with truth.tum, odometry.tum and the frames")
      .required();
  command.add_option("trajectory", options->input.trajectory, "The straightened trajectory (TUM)")
      .required();
  command.add_option("--truth", options->input.truth,
                     "The true trajectory (TUM), instead of SEQUENCE/truth.tum");
  command.add_flag("--clouds", options->input.clouds, "Reads frames too, for ghosting");
  command.add_flag("--json", options->json, "One JSON object instead of a table");
  command.footer(
      "ATE: distance of the positions after one rigid alignment of all. RPE10m: error of the "
      "motion over 10 m of path.\n"
      "Ghosting: how far apart surfaces come out that were seen twice; 'in truth' is what the true "
      "poses give.\n"
      "Stamps are paired to 2 ms. Exit 1 when an input is missing or wrong.\n\n"
      "  plumb evaluate street out/trajectory.tum --clouds");
  command.callback([options] {
    const Evaluation evaluation = evaluate(options->input);
    std::cout << (options->json ? evaluation_json(evaluation) + "\n"
                                : evaluation_table(evaluation));
    if (!options->json && evaluation.after.poses < 9 * evaluation.true_poses / 10)
      std::cout << "Only " << evaluation.after.poses << " of " << evaluation.true_poses
                << " true poses have a partner: the rows do not judge the same way, or the "
                   "trajectory is of another run.\n";
    if (!evaluation.before && !options->json)
      std::cout << "No 'before': " << options->input.sequence.string() << " has no odometry.tum.\n";
    if (options->input.clouds && !evaluation.after.ghosting && !options->json)
      std::cout << "No ghosting: it needs an estimate for every true pose.\n";
  });
}

}  // namespace plumb::command
