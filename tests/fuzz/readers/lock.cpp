#include "../fuzz.hpp"
#include "plumb/engine/record/run_record.hpp"

using namespace plumb;

PLUMB_FUZZ_READER(lock) {
  const std::string text = lock_text(read_lock(fuzz::file_of(bytes, "a.yaml")));
  fuzz::require(lock_text(read_lock(fuzz::file_of(text, "b.yaml"))) == text,
                "a record that was read is the same after it was written");
}
