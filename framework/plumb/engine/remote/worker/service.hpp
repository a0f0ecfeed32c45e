#pragma once
/// The worker's side: takes calls from its driver, makes them one at a time, answers.

#include <cstddef>
#include <string>

#include "plumb/plugin/registry.hpp"
#include "plumb/store/store.hpp"

namespace plumb {

/// Serves the socket until the driver closes it, or ends this process when the driver is gone while
/// a call runs. `memory` bounds what this process may allocate [bytes]; 0: no bound.
void serve_calls(int socket, const Registry& registry, Store& store, std::size_t memory);

/// Answers all calls with the reason why this process can make none, until the driver closes the
/// socket: who speaks to the user is the driver.
void refuse_calls(int socket, const std::string& why);

}  // namespace plumb
