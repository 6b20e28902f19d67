// The Python scripts that draw, run by the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hagfish {

/// Runs SCRIPT of experiments/drawing, or of share/hagfish/drawing of an installed program, with
/// Debian's python3. Returns its exit code. Throws InputError, one line, where there is no such
/// script, no python3, or none that has h5py and matplotlib; std::runtime_error where a signal ends
/// it.
int run_script(const std::string& script, const std::vector<std::string>& arguments);

/// Lets SCRIPT draw `out` (a PNG) from a text, as SCRIPT TEXT_FILE OUT.png. Throws as run_script,
/// as OutputFile where OUT may not be written, and std::runtime_error where the script fails.
void draw_from_text(const std::string& script, const std::string& text, const std::string& out,
                    bool force);

/// This program's own file.
std::filesystem::path own_program();

}  // namespace hagfish
