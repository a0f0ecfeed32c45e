/// libFuzzer's entry: the one driver that this program is linked with.
#include <cstddef>
#include <cstdint>

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  plumb::fuzz::refusal(plumb::fuzz::readers().at(0), {reinterpret_cast<const char*>(data), size});
  return 0;
}
