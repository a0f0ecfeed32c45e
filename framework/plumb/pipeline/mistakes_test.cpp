/// Mistakes in YAML, names and values are found, each at its place, with the nearest name.
#include <gmock/gmock.h>

#include "plumb/pipeline/testing/mistakes_testing.hpp"

namespace plumb {
namespace {

using test::cascade;
using test::told;
using test::told_with;
using test::with;
using testing::AllOf;
using testing::HasSubstr;

TEST(Mistakes, AreShownWithTheLineACaretAndTheCure) {
  EXPECT_EQ(told_with("leaf: $voxel", "laef: $voxel"),
            "a.yaml:12:59: step 'segments' (filter.voxel_grid): unknown parameter 'laef'.\n"
            "  12 |   segments: {use: filter.voxel_grid, from: merged, with: {laef: $voxel}}\n"
            "     |                                                           ^\n"
            "  Did you mean 'leaf' [length, 0.01 m to 100 m]?  Known: leaf, keep_normals.");
}

TEST(Mistakes, AreToldAllAtOnce) {
  std::string text = with("leaf: $voxel", "leaf: 3 deg");
  text.replace(text.find("frames: 30"), 10, "frames: 1e2");
  const std::string all = told(text);
  EXPECT_THAT(all, HasSubstr("a.yaml:9:79: "));
  EXPECT_THAT(all, HasSubstr("a.yaml:12:65: "));
  EXPECT_THAT(all, HasSubstr("a.yaml:6:3: nothing uses the parameter 'voxel'"));
}

TEST(Mistakes, InValues) {
  const auto leaf = [](const std::string& value) {
    return told_with("{leaf: $voxel}", "{leaf: " + value + "}");
  };
  EXPECT_THAT(leaf("0.3"), HasSubstr("a.yaml:12:65: step 'segments' (filter.voxel_grid): parameter "
                                     "'leaf': '0.3' has no unit"));
  EXPECT_THAT(leaf("0.3"), HasSubstr("Write the unit, as in '0.3 m'; known: m, cm, mm, km."));
  EXPECT_THAT(leaf("3 deg"), HasSubstr("'3 deg' is an angle, expected a length, 0.01 m to 100 m"));
  EXPECT_THAT(leaf("3 deg/m"),
              HasSubstr("'3 deg/m' is a curvature, expected a length, 0.01 m to 100 m"));
  EXPECT_THAT(told_with("parameters:", "parameters:\n  bend: {type: curvature, default: 3 m}"),
              HasSubstr("'3 m' is a length, expected a curvature.\n"));
  EXPECT_THAT(told_with("parameters:", "parameters:\n  bend: {type: curvature, default: 3 m}"),
              HasSubstr("Known units: deg/m, rad/m."));
  for (const char* good : {"3 deg/m", "0.1 rad/m"})
    EXPECT_THAT(
        told_with("parameters:",
                  std::string("parameters:\n  bend: {type: curvature, default: ") + good + "}"),
        testing::AllOf(HasSubstr("nothing uses the parameter 'bend'"),
                       testing::Not(HasSubstr("expected"))));
  EXPECT_THAT(leaf("3 metre"), HasSubstr("'metre' behind the number is not a unit"));
  EXPECT_THAT(leaf("3 mm2"), HasSubstr("Did you mean 'mm'?"));
  EXPECT_THAT(leaf("\"3, m\""), HasSubstr("Leave out the quotes."));
  EXPECT_THAT(leaf("nan"), HasSubstr("'nan' is not a number"));
  EXPECT_THAT(leaf("inf m"), HasSubstr("is not a number"));
  EXPECT_THAT(leaf("1e999 m"), HasSubstr("out of the range of numbers"));
  EXPECT_THAT(leaf("200 m"),
              HasSubstr("'200 m' is out of range, expected length, 0.01 m to 100 m"));
  EXPECT_THAT(leaf("none"), HasSubstr("'none' is not a number"));
  EXPECT_THAT(leaf(""), HasSubstr("expected a length, 0.01 m to 100 m, found nothing"));
  EXPECT_THAT(leaf("[1 m]"), HasSubstr("found a list"));
  EXPECT_THAT(told_with("frames: 30", "frames: 30 m"), HasSubstr("'30 m' is not an integer"));
  EXPECT_THAT(told_with("frames: 30", "frames: 030"), HasSubstr("'030' is not an integer"));
  EXPECT_THAT(told_with("frames: 30", "frames: 0"),
              HasSubstr("out of range, expected integer, 1 to 10000"));
  EXPECT_THAT(told_with("leaf: $voxel", "leaf: $voxel, keep_normals: yes"),
              HasSubstr("'yes' is not a boolean"));
  EXPECT_THAT(told_with("loss: huber", "loss: hubre"),
              HasSubstr("'hubre' is not one of the choices"));
  EXPECT_THAT(told_with("loss: huber", "loss: hubre"), HasSubstr("Did you mean 'huber'?"));
  EXPECT_THAT(told_with("loss: huber", "share: 0.1"),
              AllOf(HasSubstr("'0.1' has no unit, expected a ratio"),
                    HasSubstr("Write the unit: the share 0.1 is '10 %'.")));
  EXPECT_THAT(told_with("loss: huber", "share: 5"),
              HasSubstr("Write the unit, as in '5 %'; known: %."));
  const auto margin = [](const std::string& value) {
    return told_with("poses: ranges.poses}", "poses: ranges.poses}, with: {margin: " + value + "}");
  };
  EXPECT_THAT(margin("57 %"), AllOf(HasSubstr("'57 %' has a unit, expected a bare number"),
                                    HasSubstr("Write 0.57.")));
  EXPECT_THAT(margin("3 m"), HasSubstr("Leave out the 'm'."));
  EXPECT_EQ(told_with("loss: huber", "loss: none"), "");
  EXPECT_EQ(told_with("poses: ranges.poses}", "poses: ranges.poses}, with: {threshold: none}"), "");
}

TEST(Mistakes, InReferencesToParameters) {
  EXPECT_THAT(told_with("leaf: $voxel", "leaf: $voxle"),
              HasSubstr("a.yaml:12:65: step 'segments' (filter.voxel_grid): parameter 'leaf': "
                        "nothing is called '$voxle'."));
  EXPECT_THAT(told_with("leaf: $voxel", "leaf: $voxle"), HasSubstr("Did you mean 'voxel'?"));
  EXPECT_THAT(told_with("leaf: $voxel", "leaf: $gate"),
              HasSubstr("nothing is called '$gate'"));  // a row of another scope
  EXPECT_THAT(told_with("frames: 30", "frames: $voxel"),
              HasSubstr("'$voxel' does not serve: it is a length, expected an integer"));
  EXPECT_THAT(told_with("path: $input", "path: $input/sub"), HasSubstr("a reference stands alone"));
  const char* const cure = "A '$' that is text is written '$$'";
  EXPECT_THAT(told_with("path: $input", "path: $input/sub"), HasSubstr(cure));
  EXPECT_THAT(told_with("path: $input", "path: $ipnut"), HasSubstr(cure));
  EXPECT_EQ(told_with("{type: path,", "{type: path, default: $voxel,"), "");  // --set gives another
  EXPECT_THAT(told(cascade, {"input=$voxel"}),
              AllOf(HasSubstr("--set input=$voxel: parameter 'input': '$voxel' refers to another"),
                    HasSubstr(cure)));
  for (const char* text : {"input=a$b", "input=$", "input=a$$$b"})
    EXPECT_THAT(told(cascade, {text}), AllOf(HasSubstr("has a '$' in it"), HasSubstr(cure)));
  EXPECT_THAT(told_with("default: 0.3 m", "default: 300 m"),
              HasSubstr("its value 300 m does not fit, expected length, 0.01 m to 100 m"));
  EXPECT_THAT(
      told(cascade, {}),
      HasSubstr("a.yaml:5:3: parameter 'input': it has no default, and no value was given."));
  EXPECT_THAT(told_with("type: length", "type: lenght"), HasSubstr("Did you mean 'length'?"));
}

TEST(Mistakes, InAParameterThatManyStepsUseAreToldOnce) {
  const std::string text = with("  fpfh:     {use: describe.fpfh, from: segments}",
                                "  thinner:  {use: filter.voxel_grid, from: segments, with: {leaf: "
                                "$voxel}}\n"
                                "  thinnest: {use: filter.voxel_grid, from: thinner, with: {leaf: "
                                "$voxel}}\n"
                                "  fpfh: {use: describe.fpfh, from: thinnest, with: {radius: "
                                "$voxel}}");
  const std::string all = told(text, {"input=data", "voxel=-3m"});
  EXPECT_THAT(all, HasSubstr("a.yaml:12:65: step 'segments' (filter.voxel_grid): parameter 'leaf': "
                             "'$voxel' does not serve: its value -3 m does not fit, expected "
                             "length, 0.01 m to 100 m; nor does it in 2 more places.\n"));
  EXPECT_THAT(all, HasSubstr("  Its value is from --set voxel=-3m.\n"));
  EXPECT_THAT(all, testing::Not(HasSubstr("thinner")));
  // Another range is another sentence.
  EXPECT_THAT(all, HasSubstr("step 'fpfh' (describe.fpfh): parameter 'radius': '$voxel' does not "
                             "serve: its value -3 m does not fit, expected length, 0.1 m to 100 "
                             "m.\n"));
}

TEST(Mistakes, InYaml) {
  EXPECT_THAT(told("plumb: 1\nsteps: {a: [}\n"), HasSubstr("a.yaml:2:13: this is not YAML"));
  EXPECT_THAT(told_with("frames: 30", "frames: 30, frames: 40"),
              HasSubstr("a.yaml:9:83: 'frames' is written twice."));
  EXPECT_THAT(told_with("frames: 30", "<<: {frames: 30}"),
              HasSubstr("'<<' does not merge maps here"));
  EXPECT_THAT(told_with("frames: 30", "frames: !!int 30"), HasSubstr("the tag"));
  EXPECT_THAT(told_with("frames: 30", "[a]: 30"), HasSubstr("a key must be a plain word"));
  EXPECT_THAT(told_with("frames: 30", "frames: *x"), HasSubstr("a.yaml:9:"));
  EXPECT_THAT(told(cascade + "---\nplumb: 1\n"), HasSubstr("a second YAML document"));
  EXPECT_THAT(told(""), HasSubstr("a.yaml:1:1: the file is empty."));
  std::string bomb = "plumb: 1\na: &a [x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c < 'k'; ++c) {
    const std::string use = std::string("*") + static_cast<char>(c - 1);
    bomb += std::string(1, c) + ": &" + c + " [" + use + ", " + use + ", " + use + ", " + use +
            ", " + use + ", " + use + ", " + use + "]\n";
  }
  EXPECT_THAT(told(bomb), HasSubstr("more than 20000 values once aliases are expanded"));
  EXPECT_THAT(told("plumb: " + std::string(5000, '[')),
              HasSubstr("a.yaml:1:1008: nested more than 64 deep."));
  EXPECT_THAT(told("plumb: " + std::string(70, '[') + std::string(70, ']')),
              HasSubstr("nested more than 64 deep."));
}

TEST(Mistakes, InYamlAreShownInTheLineThatIsToBlame) {
  const auto of = [](const std::string& steps) { return told("plumb: 1\nsteps:\n" + steps); };
  EXPECT_THAT(of("  a: {use: x\n  b: {use: y}\n"),
              HasSubstr("a.yaml:3:6: this is not YAML: the '{' is not closed."));
  EXPECT_THAT(of("  a: {use: x, from: [y\n  b: {use: y}\n"),
              HasSubstr("a.yaml:3:21: this is not YAML: the '[' is"));
  EXPECT_THAT(of("  a: {use: x, with: {b: 1}\n\n  # c\n  c: {use: y}\n"),
              HasSubstr("a.yaml:3:6: "));
  EXPECT_THAT(of("  a: {use: x\n"), HasSubstr("a.yaml:3:6: "));
  EXPECT_THAT(of("  a:\n    use: x\n    form\n\n    with: {b: 1}\n"),
              HasSubstr("a.yaml:5:5: this is not YAML: this line has no ':'."));
  EXPECT_THAT(told("plumb 1\nsteps:\n  a: {use: y}\n"),
              HasSubstr("a.yaml:1:1: this is not YAML: this line has no"));
  EXPECT_THAT(of("\ta: {use: x}\n"),
              HasSubstr("a.yaml:3:1: this is not YAML: a tab indents this line."));
  EXPECT_THAT(of("  a: use: x\n"),
              HasSubstr("a.yaml:3:9: this is not YAML: illegal map value."));  // not moved
}

TEST(Mistakes, InKeysAndNames) {
  EXPECT_THAT(told_with("from: segments}", "form: segments}"),
              HasSubstr("a.yaml:13:34: step 'fpfh': unknown key 'form'."));
  EXPECT_THAT(told_with("from: segments}", "form: segments}"), HasSubstr("Did you mean 'from'?"));
  EXPECT_THAT(told_with("at_most", "at_mots"), HasSubstr("Did you mean 'at_most'?"));
  EXPECT_THAT(told_with("plumb: 1", "plumb: 2"), HasSubstr("Write 'plumb: 1'."));
  EXPECT_THAT(told_with("plumb: 1\n", ""), HasSubstr("'plumb: 1' is missing"));
  EXPECT_THAT(told_with("use: describe.fpfh", "use: describe.fphf"),
              HasSubstr("a.yaml:13:19: step 'fpfh': no module offers 'describe.fphf'."));
  EXPECT_THAT(told_with("use: describe.fpfh", "use: describe.fphf"),
              HasSubstr("Did you mean 'describe.fpfh'?"));
  EXPECT_THAT(told_with("use: prune.kmeans", "use: kmeans"),
              HasSubstr("Did you mean 'prune.kmeans'?"));
  EXPECT_THAT(told_with("      matches:    {use", "      ranged:    {use"),
              HasSubstr("the name 'ranged' is taken by an outer one."));
  EXPECT_THAT(told_with("  fpfh: ", "  fp-fh: "), HasSubstr("'fp-fh' is no name"));
  EXPECT_THAT(told_with("steps:\n      neighbours", "setps:\n      neighbours"),
              HasSubstr("'drift' is neither a step"));
  EXPECT_THAT(told("plumb: 1\nsteps: {}\n"), HasSubstr("the pipeline has no steps"));
}

TEST(Mistakes, OfOneStepDoNotCauseMore) {
  const std::string all = told_with("use: describe.fpfh", "use: describe.fphf");
  EXPECT_EQ(std::count(all.begin(), all.end(), '^'), 1) << all;
}

TEST(Mistakes, OfOneWordAreToldOnce) {
  const auto once = [&](const std::string& old, const std::string& fresh) {
    const std::string all = told_with(old, fresh);
    EXPECT_EQ(std::count(all.begin(), all.end(), '^'), 1) << all;
    return all;
  };
  EXPECT_THAT(once("from: merged", "from: megred"), HasSubstr("Did you mean 'merged'?"));
  EXPECT_THAT(once("from: merged", "form: merged"), HasSubstr("Did you mean 'from'?"));
  EXPECT_THAT(once("{use: describe.fpfh", "{ues: describe.fpfh"), HasSubstr("Did you mean 'use'?"));
  EXPECT_THAT(once("with: {path: $input}", "wiht: {path: $input}"),
              HasSubstr("Did you mean 'with'?"));
  EXPECT_THAT(once("leaf: $voxel", "leaf: $voxle"), HasSubstr("Did you mean 'voxel'?"));
  EXPECT_THAT(once("max: $gate", "max: $gaet"), HasSubstr("nothing is called '$gaet'"));
  EXPECT_THAT(once("from: segments}", "from: descriptors}"), HasSubstr("nothing here is called"));
}

}  // namespace
}  // namespace plumb
