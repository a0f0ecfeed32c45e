#include <cmath>

#include "../fuzz.hpp"
#include "plumb/data/amount.hpp"
#include "plumb/pipeline/yaml/value.hpp"
#include "simulate/option.hpp"

using namespace plumb;

namespace {

/// Whether `read` takes the text.
template <class Read>
bool taken(Read read) {
  try {
    read();
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

/// A number and its unit, in each of the four places that take one.
PLUMB_FUZZ_READER(quantity) {
  const std::string text(bytes);
  const auto number = pipeline::read_number(text);
  const auto* measured = std::get_if<pipeline::Measured>(&number);
  fuzz::require(!measured || std::isfinite(measured->si), "a number that was read is finite");
  bool any = measured != nullptr;
  any |= taken([&] { text_of_bytes(bytes_of_text("--memory", text)); });
  any |= taken([&] { age_of_text("--older", text); });
  const simulate::OptionRange range{"length", "", Quantity::length, 0, 1e6};
  any |= taken([&] {
    const double value = simulate::parse_quantity(range, text, true, "here");
    fuzz::require(value >= range.low && value <= range.high,
                  "a quantity that was read is in range");
    fuzz::require(
        simulate::parse_quantity(range, simulate::exactly(value, range), false, "here") == value,
        "a quantity reads back as written");
  });
  any |= taken([&] { simulate::parse_whole(range, text, "here"); });
  if (!any) throw Error("no quantity");
}
