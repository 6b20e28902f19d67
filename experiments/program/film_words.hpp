// What commands on films ask and say of a film.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/chain/model.hpp"
#include "experiments/film/film.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {

inline constexpr const char* film_help =
    "midlines: columns time_s (or frame), s_cm or point, x_cm, y_cm, perhaps z_cm (or _mm, _m, "
    "_px), or DeepLabCut's, Anipose's or DLTdv's CSV, SLEAP's analysis HDF5, EthoVision's export";

/// Exit code: no run or program is the film's.
inline constexpr int not_fitted = exit_code::wrong_knot;

/// Adds the options that say how a film is to be read.
void add_film_options(CLI::App& command, FilmReading& reading);

/// These options as words of a command line, each with a blank before it.
std::string film_option_words(const FilmReading& reading);

/// ", its animal of 35 cm scaled to 42.4 cm"; empty where the lengths are the same to 0.1 %.
std::string scaled(const Film& film, double scale);

/// A line, of a film whose animal was scaled(), and nothing says that its ends are in it.
std::string ends_note(const Film& film, const FilmReading& reading, const std::string& scaled);

/// A line, of a film whose animal is longer or shorter than the scene's, whose `figures` follow.
std::string another_animal_note(const Film& film, const FilmReading& reading,
                                const std::string& scene, const Model& model, const char* figures);

/// A line, of a film without z.
std::string flat_note(const std::string& film);

}  // namespace hagfish
