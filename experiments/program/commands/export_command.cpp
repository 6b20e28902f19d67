#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "core/input/input_text.hpp"
#include "core/log/hdf5/hdf5_error.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/export/export_tables.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string log, out;
  bool si = false, force = false;
};

int export_log(const ExportOptions& options) {
  const LogContents log(options.log, LogLevel::frames);
  std::vector<ExportTable> tables = shape_tables(log, options.si);
  for (ExportTable& table : force_tables(log, options.si)) tables.push_back(std::move(table));
  tables.push_back(phases_table(log, options.si));
  const SweptSkin swept = swept_skin(log);
  tables.push_back(skin_table(swept, log.model, options.si));
  tables.push_back(summary_table(log, swept, options.si));
  std::error_code error;
  const bool made = fs::create_directories(options.out, error);
  if (error) throw FileError(options.out + ": cannot make the folder: " + error.message());
  try {
    // All are reserved before the first is written.
    std::vector<std::unique_ptr<TextFile>> files;
    const auto reserve = [&](const std::string& name) {
      files.push_back(std::make_unique<TextFile>(fs::path(options.out) / name, options.force));
    };
    for (const ExportTable& table : tables) reserve(table.name());
    reserve("dictionary.csv");
    CsvTable dictionary{{"file", "column", "unit", "meaning"}};
    for (std::size_t k = 0; k < tables.size(); ++k) {
      tables[k].describe(dictionary);
      files[k]->write(tables[k].csv());
    }
    files.back()->write(csv_text(dictionary));
    fmt::print("{}: {} tables of {} frames, {}; dictionary.csv says what each column is\n",
               printable(options.out), tables.size(), log.time.size(),
               options.si ? "SI" : "cm, g, s, dyn");
  } catch (...) {
    if (made) fs::remove(options.out, error);  // where it is empty
    throw;
  }
  return exit_code::done;
}

}  // namespace

void add_export(Program& program) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* app = program.app.add_subcommand("export", "write a log as tables: CSV with units");
  app->add_option("LOG", options->log, "log file")->required();
  app->add_option("--out", options->out, "folder to write to, made where it is missing")
      ->required();
  app->add_flag("--si", options->si, "m, kg, N in place of cm, g, dyn");
  app->add_flag("--force", options->force, "replace existing files");
  app->callback([options, &program] { program.code = export_log(*options); });
}

}  // namespace hagfish
