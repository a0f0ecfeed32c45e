/// From what is bound to a plan: checks change nothing, and what is faulty has no plan.
#include "plumb/pipeline/plan_of.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "plumb/pipeline/testing/stages_testing.hpp"

namespace plumb::pipeline {
namespace {

using test::cascade_with;
using test::index_in;
using test::Stages;
using testing::IsEmpty;
using testing::SizeIs;

TEST(PlanOf, IsThatOfTheReader) {
  Stages stages(cascade_with({}));
  const Bound bound = stages.checked();
  ASSERT_THAT(stages.told(), IsEmpty());
  const Order order = order_of(bound, stages.diagnostics());
  const Domains domains = domains_of(bound, order, stages.diagnostics());
  const Plan plan = plan_of(bound, order, domains, {});
  const Plan again = plan_of(bound, order_of(bound, stages.diagnostics()), domains, {});
  EXPECT_EQ(plan.resolved, again.resolved);
  EXPECT_THAT(plan.order, SizeIs(12));

  const test::Folder folder;
  const Plan whole = read_pipeline(folder.write("a.yaml", cascade_with({})), {}, test::registry());
  ASSERT_EQ(whole.steps.size(), plan.steps.size());
  for (std::size_t k = 0; k < plan.steps.size(); ++k) {
    EXPECT_EQ(whole.steps[k].path, plan.steps[k].path);
    EXPECT_EQ(whole.steps[k].domain, plan.steps[k].domain);
  }
  EXPECT_EQ(whole.settings.size(), plan.settings.size());
}

TEST(PlanOf, IsThereOnlyOfWhatIsNotFaulty) {
  for (const auto& [was, now] :
       {std::pair("use: describe.fpfh", "use: describe.fphf"),
        std::pair("default: 0.3 m", "default: 0.3"), std::pair("frames: 30", "frames: 1e2"),
        std::pair("from: merged", "from: megred"),
        std::pair("carry: {poses: solved}", "carry: {poses: kept}"),
        std::pair("metric: rmse", "metric: kept"), std::pair("at_most: 6", "at_most: 2")}) {
    Stages stages(cascade_with({{was, now}}));
    const Bound bound = stages.bound(stages.declared());
    EXPECT_THAT(stages.told(), SizeIs(1)) << now;
    const Order order = order_of(bound, stages.diagnostics());
    const Domains domains = domains_of(bound, order, stages.diagnostics());
    EXPECT_THROW(plan_of(bound, order, domains, {}), std::logic_error) << now;
  }
}

TEST(PlanOf, FollowsOrderAndDomainsThatPassOverWhatIsFaulty) {
  Stages stages(cascade_with({{"use: describe.fpfh", "use: describe.fphf"}}));
  const Bound bound = stages.checked();
  const Order order = order_of(bound, stages.diagnostics());
  EXPECT_THAT(order.items, SizeIs(12));
  EXPECT_THAT(order.bodies.at(0), SizeIs(5));
  const Domains domains = domains_of(bound, order, stages.diagnostics());
  const auto domain = [&](const char* path) { return domains[index_in(bound.declared, path)]; };
  EXPECT_EQ(domain("segments"), static_cast<int>(index_in(bound.declared, "ranges")));
  EXPECT_EQ(domain("drift.matches"),
            static_cast<int>(index_in(bound.declared, "drift.neighbours")));
  EXPECT_EQ(domain("fpfh"), -1);
  EXPECT_THAT(stages.told(), SizeIs(1));
}

}  // namespace
}  // namespace plumb::pipeline
