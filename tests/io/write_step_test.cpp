// SPDX-License-Identifier: MIT
// The text of STEP and .brep files. What Open CASCADE makes of them is tested in tests/judges.
#include "bot2nurbs/write_brep.h"

#include "brep/brep_fixtures.h"
#include "io/step_text.h"

#include <charconv>
#include <ctime>
#include <gtest/gtest.h>
#include <set>
#include <thread>
#include <unistd.h>

namespace bot2nurbs {
namespace {

using namespace fixtures;

const Brep& sphere()
{
    static const Brep brep = sphere_brep(0, KnotForm::c1);
    return brep;
}

bool has(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

std::string must(const Result<std::string>& bytes)
{
    EXPECT_TRUE(bytes.ok()) << bytes.error().message;
    return bytes.ok() ? *bytes : std::string();
}

TEST(StepText, reals_become_the_shortest_that_read_back_the_same)
{
    const auto finished = [](const std::string& text) { return finish_step_text(text, {}); };
    EXPECT_EQ(finished("(1.0000000000000000E+00,-5.0000000000000000E-01)"), "(1.,-0.5)");
    EXPECT_EQ(finished("(1.0000000000000001E-01)"), "(0.1)");
    EXPECT_EQ(finished("(9.9999999999999995E-08)"), "(1.E-07)");
    EXPECT_EQ(finished("(-3.4694469519536142E-17)"), "(-3.469446951953614E-17)");
    EXPECT_EQ(finished("(1.2345678901234000E+104)"), "(1.2345678901234E+104)");
    EXPECT_EQ(finished("(-0.0000000000000000E+00)"), "(0.)");
    EXPECT_EQ(finished("#12 = X((4,2),(0.,1.),-7,.T.,$,*);"), "#12 = X((4,2),(0.,1.),-7,.T.,$,*);");
}

TEST(StepText, strings_stay_as_they_are_but_in_one_line)
{
    EXPECT_EQ(finish_step_text("('a 1.0000000000000000E+00 b',''' 2.0000000000000000E+00')", {}),
              "('a 1.0000000000000000E+00 b',''' 2.0000000000000000E+00')");
    EXPECT_EQ(finish_step_text("('one \ntwo',\n1)", {}), "('one two',\n1)");
}

TEST(StepText, names_are_escaped)
{
    const std::vector<std::string> names{"it's", "a\\b", "\xC3\xA4\xE2\x82\xAC",
                                         "\xF0\x9F\x90\xB0\n", step_name_mark(0)};
    const auto with_name = [&](std::size_t i) {
        return finish_step_text("X('" + step_name_mark(i) + "')", names);
    };
    EXPECT_EQ(with_name(0), "X('it''s')");
    EXPECT_EQ(with_name(1), "X('a\\\\b')");
    EXPECT_EQ(with_name(2), "X('\\X2\\00E4\\X0\\\\X2\\20AC\\X0\\')");
    EXPECT_EQ(with_name(3), "X('\\X4\\0001F430\\X0\\')");
    EXPECT_EQ(with_name(4), "X('" + step_name_mark(0) + "')"); // taken as it is
    EXPECT_EQ(with_name(9), "X('" + step_name_mark(9) + "')");
}

TEST(WriteStep, equal_input_gives_equal_bytes_whatever_was_written_before)
{
    const std::string first = must(brep_to_step({sphere()}));
    WriteOptions other;
    other.units = "in";
    other.step_schema = StepSchema::ap214;
    EXPECT_NE(must(brep_to_step({sphere(), sphere()}, other)), first);
    EXPECT_EQ(must(brep_to_step({sphere()})), first);
}

TEST(WriteStep, header_has_no_clock_and_no_machine)
{
    const std::string text = must(brep_to_step({sphere()}));
    const std::string header = text.substr(0, text.find("ENDSEC"));
    const std::time_t now = std::time(nullptr);
    EXPECT_FALSE(has(header, std::to_string(1900 + std::gmtime(&now)->tm_year) + "-")) << header;
    std::array<char, 256> host{};
    ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
    EXPECT_FALSE(has(text, host.data())) << header;
    EXPECT_TRUE(has(header, "FILE_NAME('bot2nurbs','1970-01-01T00:00:00'")) << header;
}

TEST(WriteStep, schema_unit_title_and_names_are_in_the_file)
{
    Brep named = sphere();
    named.name = "B\xC3\xA4r's";
    WriteOptions options;
    options.title = "model";
    options.units = "m";
    const std::string ap242 = must(brep_to_step({named, sphere()}, options));
    EXPECT_TRUE(has(ap242, "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF"));
    EXPECT_TRUE(has(ap242, "FILE_NAME('model'"));
    EXPECT_TRUE(has(ap242, "SI_UNIT($,.METRE.)"));
    EXPECT_TRUE(has(ap242, "PRODUCT('B\\X2\\00E4\\X0\\r''s','B\\X2\\00E4\\X0\\r''s'"));
    EXPECT_TRUE(has(ap242, "MANIFOLD_SOLID_BREP('B\\X2\\00E4\\X0\\r''s'"));
    EXPECT_TRUE(has(ap242, "PRODUCT('" + sphere().name));
    options.step_schema = StepSchema::ap214;
    EXPECT_TRUE(has(must(brep_to_step({named}, options)), "AUTOMOTIVE_DESIGN"));
}

TEST(WriteStep, every_control_point_is_in_the_file_to_the_bit)
{
    const std::string text = must(brep_to_step({sphere()}));
    std::set<double> numbers;
    for (std::size_t at = text.find("CARTESIAN_POINT"); at != std::string::npos;
         at = text.find("CARTESIAN_POINT", at + 1)) {
        std::size_t i = text.find('(', text.find(",", at));
        for (int k = 0; k < 3; ++k) {
            i = text.find_first_of("-0123456789", i);
            double value = 0.0;
            const auto read = std::from_chars(text.data() + i, text.data() + text.size(), value);
            numbers.insert(value);
            i = static_cast<std::size_t>(read.ptr - text.data());
        }
    }
    for (const BsplinePatch& s : sphere().surfaces) {
        for (const Vec3& p : s.control) {
            for (int k = 0; k < 3; ++k)
                EXPECT_EQ(numbers.count(p[k]), 1u);
        }
    }
}

TEST(WriteStep, works_from_several_threads_at_once)
{
    const std::string expected = must(brep_to_step({sphere()}));
    std::vector<std::string> texts(4);
    std::vector<std::thread> threads;
    for (std::string& text : texts)
        threads.emplace_back([&text] { text = must(brep_to_step({sphere()})); });
    for (std::thread& t : threads)
        t.join();
    for (const std::string& text : texts)
        EXPECT_EQ(text, expected);
}

TEST(WriteOccBrep, equal_input_gives_equal_bytes)
{
    EXPECT_EQ(must(brep_to_occ_brep({sphere()})), must(brep_to_occ_brep({sphere()})));
}

TEST(WriteBrep, prints_nothing)
{
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    must(brep_to_step({sphere()}));
    must(brep_to_occ_brep({sphere()}));
    must(brep_to_3dm({sphere()}));
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(WriteBrep, refuses_an_inward_part_with_nothing_around_it)
{
    Brep inward = sphere();
    for (BrepFace& f : inward.faces)
        f.reversed = true;
    for (const auto& bytes : {brep_to_step({inward}), brep_to_occ_brep({inward})}) {
        ASSERT_FALSE(bytes.ok());
        EXPECT_EQ(bytes.error().code, ErrorCode::brep_failed);
    }
}

TEST(WriteBrep, refuses_empty_lists_and_broken_arrays)
{
    Brep broken = sphere();
    broken.faces[2].surface = 77;
    for (auto* write : {&brep_to_step, &brep_to_occ_brep}) {
        const Result<std::string> none = (*write)({}, {}), bad = (*write)({broken}, {});
        ASSERT_FALSE(none.ok());
        ASSERT_FALSE(bad.ok());
        EXPECT_EQ(none.error().code, ErrorCode::empty_input);
        EXPECT_EQ(bad.error().code, ErrorCode::brep_failed);
    }
    for (auto* write : {&write_step, &write_occ_brep}) {
        const Status status = (*write)({sphere()}, "/missing folder/a.step", {});
        ASSERT_TRUE(status.has_value());
        EXPECT_EQ(status->code, ErrorCode::cannot_write);
    }
}

} // namespace
} // namespace bot2nurbs
