#include "tests/formats/sound_files.h"

#include <algorithm>
#include <cmath>

#include "proc/formats/alta.h"
#include "proc/formats/astm.h"
#include "proc/formats/bird.h"
#include "proc/formats/exr_atlas.h"
#include "proc/formats/exr_tiles.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/lighttools.h"
#include "proc/formats/mbsdf.h"
#include "proc/formats/pab.h"
#include "proc/formats/rgl.h"
#include "proc/formats/scattered_csv.h"
#include "proc/formats/speos.h"
#include "proc/formats/ssdd.h"
#include "proc/formats/utia.h"
#include "tests/formats/small_files.h"
#include "tests/support/spherical_tables.h"
#include "tests/support/tensor_tables.h"

namespace gonio::test {
namespace {

using proc::Channel;

proc::Metadata smallAbout() {
    proc::Metadata about;
    about.set(proc::key::kSample, "a \"test\" tile");
    about.set(proc::key::kDate, "2026-01-02T03:04:05Z");
    about.set(proc::key::kSolidAngle, "0.002");
    about.comments = {"a comment", "Wavelength (nm) = 525"};
    return about;
}

/// Two incidences, 4 azimuths, 3 thetas.
proc::SphericalTable smallBlocks(std::vector<Channel> channels,
                                 double mirrorAzimuthDeg,
                                 bool transmission = false) {
    return sphericalTable({.channels = std::move(channels),
                           .mirrorAzimuthDeg = mirrorAzimuthDeg,
                           .lightAzimuthDeg = {0},
                           .incidenceDeg = {20, 40},
                           .azimuthDeg = {0, 90, 180, 270},
                           .thetaDeg = transmission ? std::vector<double>{90, 135, 180}
                                                    : std::vector<double>{0, 30, 60},
                           .transmission = transmission},
                          [](const LightView& pair, std::size_t channel) {
                              return 0.25 + 0.1 * pair.out.y() + 0.5 * static_cast<double>(channel);
                          });
}

proc::BrdfRows smallRows(std::vector<Channel> channels, bool measured) {
    proc::BrdfRows rows;
    rows.channels = std::move(channels);
    for (const double phi : {0.0, 120.0, 240.0}) {
        rows.pairs.push_back({.in = Direction::fromSpherical(20_deg, 0_deg),
                              .out = Direction::fromSpherical(30_deg, Radians::fromDegrees(phi))});
    }
    for (std::size_t i = 0; i < rows.pairs.size() * rows.channels.size(); ++i) {
        rows.f.push_back(0.125 * static_cast<double>(i) - 0.125);
        if (!measured) continue;
        rows.uRandom.push_back(0.01);
        rows.uSystematic.push_back(0.02);
        rows.flags.push_back(Flags{Flag::Measured});
    }
    return rows;
}

}  // namespace

Files soundGonio() { return {*proc::encodeGonio(smallSample())}; }
Files soundGraw() { return {*proc::encodeGraw(smallCapture())}; }

Files soundZemax() {
    const std::string mono = smallZemax();
    const std::size_t data = mono.find("\nMonochrome\n") + 1;
    const std::string section = mono.substr(mono.find("DataBegin"));
    return {mono,
            replaced(mono.substr(0, data), "Monochrome", "XYZ") + "TristimulusX\n" + section +
                "TristimulusY\n" + section + "TristimulusZ\n" + section,
            replaced(mono, "PlaneSymmetrical", "ASymmetrical4D")};
}

Files soundLightTools() {
    Files files;
    for (const auto& channels : {std::vector<Channel>{{"", 525}},
                                 Channel::ofBands(),
                                 std::vector<Channel>{{"X", {}}, {"Y", {}}, {"Z", {}}}}) {
        const auto table = smallBlocks(channels, proc::kLightToolsMirrorDeg, channels.size() == 1);
        files.push_back(proc::writeLightTools(table, smallAbout()).bytes);
    }
    return files;
}

/// Of 3 x 2 x 4 cells: 588 bytes.
Files soundMerl() {
    std::string bytes;
    for (const char count : {'\3', '\2', '\4'}) bytes += std::string{count, 0, 0, 0};
    for (int i = 0; i < 3 * 24; ++i) {
        const double value = i % 7 == 0 ? -1 : 100.0 + i;
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);  // NOLINT
    }
    return {bytes};
}

Files soundUtia() { return {proc::writeUtia(proc::utiaGrid())->bytes}; }

Files soundRgl() {
    proc::TensorTable spectra = smallTensor();
    spectra.channels = {{"", 400}, {"", 500}, {"", 600}};
    spectra.jacobian = false;
    return {proc::writeRgl(smallTensor(), smallAbout())->bytes, proc::writeRgl(spectra)->bytes};
}

Files soundBird() {
    return {proc::writeBird(smallRows({{"", 550}}, false), {})->bytes,
            proc::writeBird(smallRows(Channel::ofBands(), true), smallAbout())->bytes,
            R"({"metadata": {}, "data": {"variables": [{"name": "theta_i", "unit": "deg"},
 {"name": "phi_i", "unit": "deg"}, {"name": "theta_r", "unit": "deg"}, {"name": "phi_r", "unit":
 "rad"}, {"name": "BRDF", "unit": "sr-1"}], "values": [[45, 0, 10, 1, 0.25], [45, 0, 20, 2, 0.5]]}}
)"};
}

Files soundSpeos() {
    const auto bands = smallBlocks(Channel::ofBands(), 0);
    return {proc::writeSpeosBrdf(bands, smallAbout())->bytes,
            proc::writeSpeosAnisotropic(bands, smallAbout())->bytes,
            proc::writeSpeosBrdf(smallBlocks({{"", 525}}, 0, true), {})->bytes};
}

Files soundMbsdf() {
    Files files;
    for (const bool colours : {false, true}) {
        auto table =
            proc::mbsdfGrid(colours ? Channel::ofBands() : std::vector<Channel>(1),
                            {.thetas = 3, .azimuths = 4},
                            colours ? std::optional(proc::MbsdfShape{2, 2}) : std::nullopt);
        for (auto& block : table.blocks) std::fill(block.f.begin(), block.f.end(), 0.25);
        files.push_back(proc::writeMbsdf(table, smallAbout())->bytes);
    }
    return files;
}

Files soundSsdd() {
    const auto bands = smallBlocks(Channel::ofBands(), 180);
    return {proc::writeSsdd(bands, smallAbout())->bytes,
            proc::writeSsdd(bands, smallAbout(), proc::SsddData::Binary)->bytes,
            "VERSION 0.2\n# of XYZ\nDATA_TYPE btdf\nCOLOR_MODEL xyz\n"
            "PARAM_TYPE specular_coordinate_system\nREDUCTION_TYPE bilateral_symmetry\n"
            "PARAM0_LIST 0 80\nPARAM2_LIST 0 180\nPARAM3_LIST 0 180\nDATA ascii\n"
            "0.1 0.2 0.3\n1 2 3\n0.4 0.5 0.6\n1 2 3\n0.1 0.2 0.3\n1 2 3\n0.7 0.8 0.9\n1 2 3\n"};
}

Files soundCsv() {
    return {proc::writeScatteredCsv(smallRows({{}}, false), {}).bytes,
            proc::writeScatteredCsv(smallRows(Channel::ofBands(), true), smallAbout()).bytes,
            "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f_650nm,\"other, column\"\n0,0,1,1,0,1,0.5,x\n"};
}

Files soundAstm() {
    return {proc::writeAstm(smallRows(Channel::ofBands(), false), smallAbout())->bytes,
            "KEY a value\nNUM_POINTS 2\nVARS theta_i,theta_s,phi_s,550nm,650nm\n"
            "0.1,0.2,-0.3,1,2\n\n0.1,2.2,0.3,-1,2\n"};
}

Files soundPab() {
    Files files;
    for (const auto& channels :
         {std::vector<Channel>(1), std::vector<Channel>{{"X", {}}, {"Y", {}}, {"Z", {}}}}) {
        files.push_back(proc::writePab(smallRows(channels, false), smallAbout())->files[0].bytes);
    }
    files.push_back(
        "#data written by hand\n#sample_name \"blind\"\n#incident_angle 30 90\n"
        "#upphi 45\n#format: theta phi DSF\n60 270 0.25\n120.000\t10 0.5\n");
    return files;
}

Files soundAlta() {
    const std::string cosine =
        "#SAMPLE \"tape\"\n# a comment\n#DIM 3 1\n#VS 0\n"
        "#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n"
        "0.25  0.5 0   0.125\n0.25\t0\t-1\t0.5\n";
    Files files{proc::writeAlta(smallRows(Channel::ofBands(), false), smallAbout())->bytes, cosine};
    for (const char* other : {"RUSIN_TH_TD_PD", "ISOTROPIC_TV_TL_DPHI"}) {
        files.push_back(replaced(cosine, "ISOTROPIC_TL_TV_PROJ_DPHI", other));
    }
    return files;
}

Files soundExrTiles() {
    proc::SpecularTable table;
    const auto grid = proc::exrTileGrid({0, 30}, {8, 4});
    table.symmetry = proc::TableSymmetry::Asymmetrical;
    table.incidenceDeg = grid.incidenceDeg;
    table.azimuthDeg = grid.azimuthDeg;
    table.radialDeg = grid.radialDeg;
    proc::TablePlane plane;
    plane.f.assign(table.nodeCount(), 0.25);
    plane.tis.assign(2, 0.5);
    table.planes = {plane};
    return {proc::encodeExrTiles(table, smallAbout())->bytes,
            proc::encodeExrTiles(table, {}, {.half = true, .columns = 1})->bytes};
}

/// Two samples that are one another's metadata's only difference.
Files soundExrAtlas() {
    const auto tiles = proc::decodeExrTiles(soundExrTiles().front(), "tiles");
    const proc::AtlasSample sample{.table = tiles->content, .about = smallAbout()};
    const std::vector samples(2, sample);
    return {proc::encodeExrAtlas(samples)->bytes, soundExrTiles().front()};
}

Files soundRt300s() {
    return {
        "azimuth_deg,incidence_deg,receive_deg,RT\n-90,10,-80,0.0022\n-90,10,10,-0.004\n"
        "90,30,75.5,1e-3\n",
        "DataType:\tBRDF(RT-300S)\t \t\rSampleID:\tSample 0\t \t\rDate:\t7/12/2011\t\t\r"
        "Incidence:\t30\t \t\rPolar:\t-30,30,30\t \t\rAzimuth:\t-90,-80,10\t \t\r\t\t\t\r"
        "Raw data\t\t\t\r\t-30\t0\t30\r-90\t0\t1.5\t-2\r-80\t3\t4\t5\r\t\t\t\r"};
}

/// A basis of one cap and a ring of two patches.
Files soundKlems() {
    return {
        "<?xml version=\"1.0\"?>\n<WindowElement xmlns=\"http://windows.lbl.gov\">\n"
        "<Optical><Layer>\n<Material><Name> a shade </Name><Thickness unit=\"Millimeter\">1"
        "</Thickness></Material>\n<DataDefinition>\n"
        "<IncidentDataStructure>Columns</IncidentDataStructure>\n"
        "<AngleBasis><AngleBasisName>own</AngleBasisName>\n"
        "<AngleBasisBlock><Theta>0</Theta><ThetaBounds><LowerTheta>0</LowerTheta>"
        "<UpperTheta>30</UpperTheta></ThetaBounds>\n<nPhis>1</nPhis></AngleBasisBlock>\n"
        "<AngleBasisBlock><Theta>60</Theta><ThetaBounds><LowerTheta>30</LowerTheta>"
        "<UpperTheta>90</UpperTheta></ThetaBounds>\n<nPhis>2</nPhis></AngleBasisBlock>\n"
        "</AngleBasis></DataDefinition>\n<WavelengthData>\n"
        "<Wavelength unit=\"Integral\">Visible</Wavelength>\n<WavelengthDataBlock>\n"
        "<WavelengthDataDirection>Reflection Front</WavelengthDataDirection>\n"
        "<ColumnAngleBasis>own</ColumnAngleBasis>\n<RowAngleBasis>own</RowAngleBasis>\n"
        "<ScatteringDataType>BTDF</ScatteringDataType>\n<!-- nine -->\n<ScatteringData>\n"
        "0.01, 0.02, 0.03,\n0.04, 0.05, 0.06,\n0.07, 0.08, 0.09\n"
        "</ScatteringData></WavelengthDataBlock></WavelengthData>\n"
        "</Layer></Optical></WindowElement>\n"};
}

/// One scan of 3 thetas x 2 phis.
Files soundStil() {
    return {
        "Name / Comment :\tplate\t\rData file type :\tBRDF\t\rTheta measure beginning :\t-30\t\r"
        "Theta measure end :\t30\t\rTheta measure step :\t30\t\rPhi measure beginning :\t-90\t\r"
        "Phi measure end :\t-80\t\rPhi measure step :\t10\t\rTheta Lighting\t20\t\r"
        "-30\t1\t2\r0\t3\t4\r30\t5\t6\r\t\t\r"};
}

Files soundPoints() { return {smallPoints()}; }

Files soundHeads() {
    return {
        smallZemax(), smallPoints(), std::string("tensor_file\0\1\0", 14), "AOI 10\nSide Front\n"};
}

}  // namespace gonio::test
