#include "plumb/engine/remote/worker/image.hpp"

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

std::vector<ImageValue> values_of(const ParameterValues& values) {
  std::vector<ImageValue> image;
  for (const auto& [name, value] : values) {
    ImageValue& to = image.emplace_back();
    to.name = name;
    to.kind = static_cast<std::uint8_t>(value.index());
    if (const auto* v = std::get_if<bool>(&value)) to.boolean = *v;
    if (const auto* v = std::get_if<std::int64_t>(&value)) to.integer = *v;
    if (const auto* v = std::get_if<double>(&value)) to.number = *v;
    if (const auto* v = std::get_if<std::string>(&value)) to.text = *v;
  }
  return image;
}

ParameterValues values_from(const std::vector<ImageValue>& image) {
  ParameterValues values;
  for (const ImageValue& from : image) {
    ParameterValue& to = values[from.name];
    if (from.kind == ParameterValue(true).index()) to = from.boolean;
    if (from.kind == ParameterValue(std::int64_t{}).index()) to = from.integer;
    if (from.kind == ParameterValue(0.0).index()) to = from.number;
    if (from.kind == ParameterValue(std::string()).index()) to = from.text;
  }
  return values;
}

class Imaging {
 public:
  explicit Imaging(std::vector<StepRun*>& runs) : runs_(runs) {}

  std::int64_t add(StepRun& run, bool called) {
    for (std::size_t r = 0; r < runs_.size(); ++r)
      if (runs_[r] == &run) return static_cast<std::int64_t>(r);
    ImageRun entry;
    entry.path = run.plan().path;
    entry.step = run.plan().description->name;
    entry.values = values_of(run.values());
    entry.role = role_of(run, called);
    switch (entry.role) {
      case ImageRole::items:
        run.require_in_store();
        entry.keys = run.item_keys();
        if (run.list_source().run) entry.list = wire_of(run.list_source());
        break;
      case ImageRole::whole:
        run.require_in_store();
        entry.keys = {run.whole_key()};
        entry.value_keys = run.whole_keys();
        if (run.list_source().run) entry.list = wire_of(run.list_source());
        break;
      default:
        for (const auto& port : run.inputs()) {
          auto& wires = entry.inputs.emplace_back();
          for (const Source& source : port) wires.push_back(wire_of(source));
        }
    }
    runs_.push_back(&run);
    image.runs.push_back(std::move(entry));
    return static_cast<std::int64_t>(runs_.size()) - 1;
  }

  Image image;

 private:
  static ImageRole role_of(const StepRun& run, bool called) {
    if (called) return ImageRole::call;
    if (run.itemwise())
      return run.keeping() == Keeping::passing ? ImageRole::pass : ImageRole::items;
    return run.lazy() ? ImageRole::open : ImageRole::whole;
  }
  ImageWire wire_of(const Source& source) {
    return {add(*source.run, false), source.output, source.label};
  }
  std::vector<StepRun*>& runs_;
};

}  // namespace

Image image_of(StepRun& run, std::vector<StepRun*>& runs) {
  runs.clear();
  Imaging imaging(runs);
  imaging.add(run, true);
  return std::move(imaging.image);
}

ImageRuns::ImageRuns(const Image& image, const Registry& registry, RunState state, Opened& opened) {
  for (const ImageRun& run : image.runs) runs_.push_back(make(run, registry, state, opened));
}

std::shared_ptr<StepRun> ImageRuns::make(const ImageRun& from, const Registry& registry,
                                         const RunState& state, Opened& opened) {
  bool wired = false;
  for (const auto& port : from.inputs) wired |= !port.empty();
  if (from.role == ImageRole::open && !wired) {  // opened once for all images of this process
    const Hash128 name = content_hash(from);
    const auto at = opened.find(name);
    if (at == opened.end()) {
      Image alone;
      alone.runs = {from};
      alone.runs[0].role = ImageRole::call;
      Opened none;
      const auto fresh = std::make_shared<ImageRuns>(alone, registry, state, none);
      fresh->target().start();
      opened[name] = fresh;
    }
    return opened[name]->runs_.back();
  }
  const StepDescription* description = registry.find(from.step);
  if (!description)
    throw Error("this worker has no step '" + from.step +
                "'; give workers the same plugins as the run");
  auto& plan = plans_.emplace_back(std::make_unique<PlannedStep>());
  plan->path = from.path;
  plan->description = description;
  std::vector<std::vector<Source>> inputs;
  for (const auto& port : from.inputs) {
    auto& sources = inputs.emplace_back();
    for (const ImageWire& wire : port)
      sources.push_back({runs_.at(wire.run), static_cast<int>(wire.output), wire.label});
  }
  const Keeping keeping = from.role == ImageRole::pass ? Keeping::passing : Keeping::kept;
  auto run = std::make_shared<StepRun>(*plan, registry.step(from.step), values_from(from.values),
                                       std::move(inputs), keeping, state);
  Source list;
  if (from.list.run >= 0) list = {runs_.at(from.list.run), static_cast<int>(from.list.output), ""};
  switch (from.role) {
    case ImageRole::call:
    case ImageRole::pass:
      run->join();
      break;
    case ImageRole::open:
      run->start();
      break;
    case ImageRole::whole:
    case ImageRole::items:
      run->adopt(from.keys, from.value_keys, std::move(list));
      break;
  }
  return run;
}

std::int64_t ImageRuns::index_of(const StepRun& run) const {
  for (std::size_t r = 0; r < runs_.size(); ++r)
    if (runs_[r].get() == &run) return static_cast<std::int64_t>(r);
  return -1;
}

}  // namespace plumb
