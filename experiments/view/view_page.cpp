#include "experiments/view/view_page.hpp"

#include <fstream>
#include <sstream>

#include "core/log/hdf5/hdf5_error.hpp"

namespace hagfish {
namespace {

/// Where Debian has the libraries that go into the page.
struct Library {
  const char* file;
  const char* package;
};
constexpr Library libraries[] = {
    {"/usr/share/javascript/three/three.min.js", "libjs-three"},
    {"/usr/share/javascript/three/examples/js/controls/OrbitControls.js", "libjs-three"},
    {"/usr/share/nodejs/d3/dist/d3.min.js", "node-d3"}};
// Their licences ask for this much.
constexpr const char* notice =
    "/* three.js and OrbitControls: copyright 2010-2019 three.js authors, MIT licence. D3: "
    "copyright 2010-2020 Mike Bostock, BSD licence. */\n";

std::string read_library(const Library& library) {
  std::ifstream file(library.file, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file || text.str().empty()) {
    throw FileError(std::string(library.file) + ": no such file: the viewer needs Debian's " +
                    library.package);
  }
  return text.str();
}

std::string script(const std::string& text) { return "<script>" + text + "</script>\n"; }

}  // namespace

std::string view_page(const std::vector<nlohmann::ordered_json>& logs) {
  std::string scripts = script(notice);
  for (const Library& library : libraries) scripts += script(read_library(library));
  // Texts of a log are anyone's: nothing in them ends the script.
  std::string data = nlohmann::ordered_json(logs).dump(
      -1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos;) {
    data.replace(at, 1, "\\u003c");
  }
  scripts += script("const LOGS=" + data + ";");
  for (const char* name : {"quantities.js", "body.js", "plots.js", "viewer.js"}) {
    scripts += script(std::string(view_file(name)));
  }
  scripts += script("const viewer = new Viewer(LOGS.map((raw) => new Log(raw)));");
  std::string page(view_file("page.html"));
  const auto put = [&page](const std::string& mark, const std::string& text) {
    page.replace(page.find(mark), mark.size(), text);
  };
  put("/*STYLE*/", std::string(view_file("style.css")));
  put("<!--SCRIPTS-->", scripts);
  return page;
}

}  // namespace hagfish
