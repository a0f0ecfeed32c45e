#pragma once
/// A step run as another process needs it to make its calls: the steps that it draws on, with their
/// parameters, and the keys of what lies in the store.

#include <map>
#include <memory>
#include <vector>

#include "plumb/engine/run/step_run.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {

struct ImageWire {
  std::int64_t run = -1, output = -1;  ///< index into Image::runs, and its output
  std::string label;
};

/// How another process gets a run's values.
enum class ImageRole : std::uint8_t {
  call,   ///< its calls are asked for
  pass,   ///< makes its items itself whenever asked
  open,   ///< runs the step again, to have what makes its lazy values
  items,  ///< from the store, by item
  whole,  ///< from the store, as one result
};

struct ImageValue {
  std::string name;
  std::uint8_t kind = 0;  ///< index into ParameterValue
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0;
  std::string text;
};

struct ImageRun {
  std::string path, step;
  ImageRole role = ImageRole::call;
  std::vector<ImageValue> values;
  std::vector<std::vector<ImageWire>> inputs;    ///< by port; of call, pass and open
  std::vector<Hash128> keys;                     ///< of items: by item; of whole: one
  std::vector<std::vector<Hash128>> value_keys;  ///< of whole: by output
  ImageWire list;  ///< of values of listed items (edges): where the list is
};

struct Image {
  std::vector<ImageRun> runs;  ///< each after those that it draws on; the last one is the one whose
                               ///< calls are asked for
};

/// The image of a run whose inputs are joined, and in `runs` what its entries stand for. Throws
/// Error when something that it needs is not in the store.
Image image_of(StepRun& run, std::vector<StepRun*>& runs);

/// The runs of an image in this process.
class ImageRuns {
 public:
  /// Runs that only open their input (ImageRole::open) are taken from `opened`, which outlives
  /// images. Throws Error.
  using Opened = std::map<Hash128, std::shared_ptr<ImageRuns>>;
  ImageRuns(const Image& image, const Registry& registry, RunState state, Opened& opened);
  StepRun& target() { return *runs_.back(); }
  /// The place of a run in the image; -1 for none.
  std::int64_t index_of(const StepRun& run) const;

 private:
  std::shared_ptr<StepRun> make(const ImageRun& run, const Registry& registry,
                                const RunState& state, Opened& opened);
  std::vector<std::unique_ptr<PlannedStep>> plans_;
  std::vector<std::shared_ptr<StepRun>> runs_;
};

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, ImageWire>
void fields(Archive& a, T& w) { a(w.run, w.output, w.label); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, ImageValue>
void fields(Archive& a, T& v) { a(v.name, v.kind, v.boolean, v.integer, v.number, v.text); }
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, ImageRun>
void fields(Archive& a, T& r) {
  a(r.path, r.step, r.role, r.values, r.inputs, r.keys, r.value_keys, r.list);
}
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Image>
void fields(Archive& a, T& i) { a(i.runs); }

}  // namespace plumb
