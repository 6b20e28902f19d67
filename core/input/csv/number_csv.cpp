#include "core/input/csv/number_csv.hpp"

#include <fmt/format.h>

#include <optional>
#include <sstream>
#include <utility>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"

#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

namespace hagfish {
namespace {

template <std::size_t N, std::size_t... I>
void read_rows(const std::string& text, const std::string& name,
               const std::array<std::string, N>& columns, const RowTaker<N>& take,
               std::index_sequence<I...> /*columns*/) {
  std::istringstream stream(text);
  io::CSVReader<N, io::trim_chars<' ', '\t'>, io::double_quote_escape<',', '"'>,
                io::throw_on_overflow, io::single_and_empty_line_comment<'#'>>
      reader(name, stream);
  reader.read_header(io::ignore_extra_column, columns[I]...);
  const auto fail = [&](const std::string& why) {
    throw_input_error(fmt::format("{}:{}: {}", name, reader.get_file_line(), why));
  };
  std::array<char*, N> field;
  while (reader.read_row(field[I]...)) {
    std::array<double, N> row;
    for (std::size_t i = 0; i < N; ++i) {
      const std::optional<double> value = finite_number(field[i]);
      if (!value) {
        fail(fmt::format("{} = {}: must be a number", columns[i], shortened(field[i])));
      }
      row[i] = *value;
    }
    if (const std::string why = take(row); !why.empty()) fail(why);
  }
}

}  // namespace

template <std::size_t N>
void read_number_csv(const std::string& text, const std::string& name,
                     const std::array<std::string, N>& columns, const RowTaker<N>& take) {
  try {
    read_rows(text, name, columns, take, std::make_index_sequence<N>());
  } catch (const io::error::base& error) {
    throw_input_error(name + ": " + error.what());
  }
}

template void read_number_csv(const std::string&, const std::string&,
                              const std::array<std::string, 5>&, const RowTaker<5>&);

}  // namespace hagfish
