// MJCF of any origin: no more than models of this program have, and no other file.
#include "mujoco_ref/mjcf_vocabulary.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::mjcf_vocabulary_test {

using Files = std::map<std::string, std::string>;

std::string refusal(const Files& files) {
  return error_of<std::runtime_error>([&] { check_vocabulary(files); });
}

/// The root document with `inside` in it, and a file that it may include.
Files root(const std::string& inside) {
  return {{mjcf_root_file, "<mujoco>\n" + inside + "</mujoco>"}, {"more.xml", "<mujocoinclude/>"}};
}

TEST(MjcfVocabulary, HasAllThatIsWritten) {
  const Scene scene = table1_scene();
  for (const Head head : {Head::free, Head::clamped}) {
    const Files files =
        mjcf_files(table1_hagfish(), scene.contact.least_arc, scene.time.step, head);
    EXPECT_EQ(refusal(files), "no error");
  }
}

TEST(MjcfVocabulary, RefusesWhatCanNameAFile) {
  for (const std::string element :
       {"asset", "mesh", "hfield", "texture", "skin", "extension", "plugin"}) {
    EXPECT_EQ(refusal(root("<" + element + " file=\"/etc/passwd\"/>")),
              "hagfish.xml: <" + element + "> at line 2 is in no model of this program");
  }
  for (const std::string attribute : {"meshdir", "texturedir", "file"}) {
    EXPECT_EQ(
        refusal(root("<compiler " + attribute + "=\"/etc\"/>")),
        "hagfish.xml: " + attribute + " of <compiler> at line 2 is in no model of this program");
  }
}

TEST(MjcfVocabulary, IncludesOnlyItsOwnFilesAndEachOnce) {
  const auto include = [](const std::string& name) { return "<include file=\"" + name + "\"/>"; };
  EXPECT_EQ(refusal(root(include("more.xml"))), "no error");
  for (const std::string name : {"/etc/passwd", "../more.xml", "none.xml", ""}) {
    EXPECT_EQ(refusal(root(include(name))),
              "hagfish.xml: includes " + name + ", which is not one of its files");
  }
  EXPECT_EQ(refusal(root("<include/>")),
            "hagfish.xml: includes nothing, which is not one of its files");
  EXPECT_EQ(refusal(root(include("more.xml") + include("more.xml"))),
            "hagfish.xml: includes more.xml once more");
  EXPECT_EQ(refusal(root(include("hagfish.xml"))), "hagfish.xml: includes hagfish.xml once more");
}

TEST(MjcfVocabulary, BoundsWhatTakesMemory) {
  for (const std::string value : {"2000000000", "-1", "5001", "x", "99999999999999"}) {
    EXPECT_EQ(refusal(root("<size njmax=\"" + value + "\"/>")),
              "hagfish.xml: njmax must be a whole number from 0 to 5000");
  }
  std::string bodies;
  for (int b = 0; b < 400; ++b) bodies += "<body/>";
  EXPECT_EQ(refusal(root(bodies)), "no error");
  EXPECT_EQ(refusal(root(bodies + "<body/>")), "hagfish.xml: more than 400 bodies");
}

TEST(MjcfVocabulary, RefusesWhatIsNotXml) {
  EXPECT_EQ(refusal(root("<body>")),
            "hagfish.xml: XML parse error at line 2: XML_ERROR_MISMATCHED_ELEMENT");
  Files deep = root("");
  for (int i = 0; i < 20000; ++i) deep["more.xml"] += "<body>";
  EXPECT_EQ(refusal(deep), "more.xml: XML parse error at line 1: XML_ELEMENT_DEPTH_EXCEEDED");
}

TEST(MujocoErrors, AreThrownInOneLineAndWriteNoFile) {
  const Scene scene = table1_scene();
  const MujocoModel any(mjcf_files(table1_hagfish(), scene.contact.least_arc, scene.time.step));
  EXPECT_EQ(error_of<std::runtime_error>([] { mju_error("the stack\nis full"); }),
            "MuJoCo: the stack is full");
  mju_warning("of no use");
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

}  // namespace hagfish::mjcf_vocabulary_test
