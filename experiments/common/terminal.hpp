// Words for whoever sits at the terminal. They are a courtesy: a run goes on where nobody reads.
#pragma once

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <utility>

namespace hagfish {

/// Prints to standard error, and ignores that this fails, as on a full disk or a closed stream.
template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  std::fputs(fmt::format(format, std::forward<Values>(values)...).c_str(), stderr);
}

/// Opens what is closed of standard input, output and error as /dev/null, so that no file of the
/// program's own takes their places.
void open_standard_streams();

/// Whether all that was printed to standard output arrived there.
bool standard_output_arrived();

/// Signals that ask a process to end. Schedulers send the last three before a job's time is up.
inline constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU};

/// Has ending_signals noted instead, for `interrupted` to tell, a second one of a kind ends the
/// process, and failed writes (SIGPIPE, SIGXFSZ) reported as errors.
void note_signals();
bool interrupted();

}  // namespace hagfish
