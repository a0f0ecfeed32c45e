#pragma once
/// The log of the calls that count, which calls.py reads: FAULTS_LOG in the environment names a
/// file to which a line is added for each.
///
/// A line: number, process, call, result, errno, whether it was made to fail (1), file descriptor,
/// offset, flags, path, second path, the bytes that were written in hexadecimal digits, and who
/// called: MODULE+OFFSET from the inside out. Tabs stand between them.

#include "watch.hpp"

namespace faults {

/// Makes ready what a line needs; before the first call is counted, since it makes some itself.
void open_log();
/// Adds a call to the log, with what it gave and the errno of that.
void log(const Call& call, const Fate& fate, long result, int error);

}  // namespace faults
