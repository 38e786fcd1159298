#include "study/trial_page.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/svg_plot.h"

namespace cathlab {
namespace {

constexpr double margin_mm = 12.0;  // round the vessels ...
constexpr double around_mm = 70.0;  // ... of which so much is shown round the tip's way
constexpr double field_mm = 150.0;  // across the C-arm's view
constexpr double force_width = 720.0, force_height = 120.0, force_most = 1.5;  // px, px, of the limit

constexpr const char* style = R"css(
body { font: 15px/1.45 sans-serif; color: #202020; background: #ffffff; max-width: 960px; margin: 1.5em auto; padding: 0 1em; }
h1 { font-size: 1.3em; }
.views { display: flex; gap: 1em; flex-wrap: wrap; }
figure { margin: 0; flex: 1 1 260px; }
figure svg { width: 100%; height: 440px; background: #f6f6f6; }
figure canvas { width: 100%; height: 440px; background: #d8d8d8; }
figcaption { font-size: 0.9em; }
.force { width: 100%; height: auto; }
.controls { display: flex; gap: 0.8em; align-items: center; margin: 0.8em 0; }
.controls input[type=range] { flex: 1; }
output { min-width: 15em; font-variant-numeric: tabular-nums; }
)css";

// Data first.  frames: time [s], x, y, z [mm], force [of the limit], beam, primary, secondary [deg], device [mm: x, y,
// z of the first point, then steps, in tenths].  vessels: x, y, z, radius of either end [mm].
constexpr const char* script = R"js(
const byId = id => document.getElementById(id);
const slider = byId('time'), button = byId('play'), pace = byId('pace');
const dots = [byId('tip0'), byId('tip1')], trails = [byId('trail0'), byId('trail1')];
const picture = byId('beam'), ink = picture.getContext('2d');
// Image right and down of a C-arm, as the simulator's detector has them.
function axes(f) {
  const a = f[6] * Math.PI / 180, b = f[7] * Math.PI / 180;
  const forward = [Math.sin(a) * Math.cos(b), -Math.cos(a) * Math.cos(b), Math.sin(b)];
  const right = [Math.cos(a), Math.sin(a), 0];
  const down = [right[1] * forward[2] - right[2] * forward[1], right[2] * forward[0] - right[0] * forward[2],
                right[0] * forward[1] - right[1] * forward[0]];
  return [right, down];
}
const along = (p, axis) => p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2];
function line(f) {
  const points = [];
  let p = [0, 0, 0];
  for (let i = 0; i < f[8].length; i += 3) {
    p = [p[0] + f[8][i] / 10, p[1] + f[8][i + 1] / 10, p[2] + f[8][i + 2] / 10];
    points.push(p);
  }
  return points;
}
function seen(f) {
  const scale = Math.min(2, devicePixelRatio || 1), w = picture.width = scale * picture.clientWidth;
  const h = picture.height = scale * picture.clientHeight, mm = Math.min(w, h) / fieldMm;
  const [right, down] = axes(f), tip = [f[1], f[2], f[3]];
  const at = p => [w / 2 + mm * (along(p, right) - along(tip, right)), h / 2 + mm * (along(p, down) - along(tip, down))];
  ink.lineCap = ink.lineJoin = 'round';
  ink.strokeStyle = '#c2bcbc';
  for (const v of vessels) {
    ink.lineWidth = mm * (v[3] + v[7]);
    ink.beginPath();
    ink.moveTo(...at(v));
    ink.lineTo(...at(v.slice(4)));
    ink.stroke();
  }
  const points = line(f);
  ink.strokeStyle = '#202020';
  ink.lineWidth = mm * deviceMm;
  ink.beginPath();
  points.forEach((p, i) => i ? ink.lineTo(...at(p)) : ink.moveTo(...at(p)));
  ink.stroke();
  ink.fillStyle = f[4] >= 1 ? '#d55e00' : '#0072b2';
  ink.beginPath();
  ink.arc(w / 2, h / 2, Math.max(3, mm * 1.5), 0, 7);
  ink.fill();
  const side = (x, plus, minus) => x ? ` ${x > 0 ? plus : minus} ${Math.abs(x).toFixed(0)}` : '';
  byId('angles').textContent = 'As the C-arm stood:' + (side(f[6], 'LAO', 'RAO') + side(f[7], 'CRAN', 'CAUD') || ' AP');
}
const place = (view, f) => [view === 0 ? f[1] : f[2], -f[3]];
let now = 0, last = null;
function show(k) {
  now = Math.max(0, Math.min(frames.length - 1, k));
  const f = frames[Math.floor(now)];
  for (let v = 0; v < 2; ++v) {
    const p = place(v, f);
    dots[v].setAttribute('cx', p[0]);
    dots[v].setAttribute('cy', p[1]);
    trails[v].setAttribute('points', frames.slice(0, Math.floor(now) + 1).map(g => place(v, g).join(',')).join(' '));
  }
  byId('cursor').setAttribute('transform', `translate(${forceX(f[0])} 0)`);
  seen(f);
  slider.value = Math.floor(now);
  byId('reading').textContent = `${f[0].toFixed(1)} s, force ${(100 * f[4]).toFixed(0)} % of the limit` + (f[5] ? ', X-rays' : '');
}
const forceX = t => forceWidth * (t - frames[0][0]) / Math.max(1e-9, frames[frames.length - 1][0] - frames[0][0]);
const step = frames.length > 1 ? (frames[frames.length - 1][0] - frames[0][0]) / (frames.length - 1) : 1;
function tick(at) {
  if (last === null) return;
  show(now + (at - last) / 1000 * pace.value / step);
  last = at;
  if (now >= frames.length - 1) stop(); else requestAnimationFrame(tick);
}
function stop() { last = null; button.textContent = 'Play'; }
function start() {
  if (now >= frames.length - 1) show(0);
  button.textContent = 'Pause';
  last = performance.now();
  requestAnimationFrame(tick);
}
button.onclick = () => last === null ? start() : stop();
slider.oninput = () => { stop(); show(+slider.value); };
onresize = () => show(now);
show(0);
)js";

std::string fixed(double value, int digits) {
    std::array<char, 64> buffer{};
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, digits).ptr;
    return {buffer.data(), end};
}

/// World to picture: from the front the patient's left (+x) is to the right, from the left side the back (+y) is; z is
/// up.
std::string point(const Vec3& p, int view) {
    return fixed(view == 0 ? p.x() : p.y(), 1) + "," + fixed(-p.z(), 1);
}

struct Window {
    double low_x = std::numeric_limits<double>::infinity(), low_y = low_x, high_x = -low_x, high_y = -low_x;
    void add(const Vec3& p, double r, int view) {
        const double x = view == 0 ? p.x() : p.y();
        low_x = std::min(low_x, x - r);
        high_x = std::max(high_x, x + r);
        low_y = std::min(low_y, -p.z() - r);
        high_y = std::max(high_y, -p.z() + r);
    }
    Window within(const Window& other) const {
        return {std::max(low_x, other.low_x), std::max(low_y, other.low_y), std::min(high_x, other.high_x),
                std::min(high_y, other.high_y)};
    }
};

std::string view_of(int view, const char* name, const CentrelineGraph& vessels, std::span<const TrialFrame> frames) {
    Window all, near;
    for (const CentrelineNode& node : vessels.nodes) all.add(node.position, node.radius + margin_mm, view);
    for (const TrialFrame& f : frames) {
        all.add(f.tip, 1.0, view);
        near.add(f.tip, around_mm, view);
    }
    const Window window = near.within(all);
    std::string out = "<figure><svg viewBox=\"" + fixed(window.low_x, 1) + " " + fixed(window.low_y, 1) + " " +
                      fixed(window.high_x - window.low_x, 1) + " " + fixed(window.high_y - window.low_y, 1) +
                      "\" role=\"img\"><g stroke=\"#e3c9c9\" stroke-linecap=\"round\">\n";
    for (const auto& [a, b] : vessels.edges) {
        const CentrelineNode& from = vessels.nodes[static_cast<std::size_t>(a)];
        const CentrelineNode& to = vessels.nodes[static_cast<std::size_t>(b)];
        out += "<polyline points=\"" + point(from.position, view) + " " + point(to.position, view) +
               "\" stroke-width=\"" + fixed(from.radius + to.radius, 1) + "\"/>\n";
    }
    out += "</g><polyline fill=\"none\" stroke=\"#909090\" stroke-width=\"1\" points=\"";
    for (const TrialFrame& f : frames) out += point(f.tip, view) + " ";
    const std::string v = std::to_string(view);
    out += "\"/><polyline id=\"trail" + v +
           "\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"1.6\"/><circle id=\"tip" + v +
           "\" r=\"4\" fill=\"#d55e00\"/></svg><figcaption>" + name + "</figcaption></figure>\n";
    return out;
}

std::string force_plot(std::span<const TrialFrame> frames) {
    const double first = frames.front().time_s, span = std::max(1e-9, frames.back().time_s - first);
    const auto y = [](double force) { return force_height * (1.0 - std::min(force, force_most) / force_most); };
    const std::string limit = fixed(y(1.0), 1);
    std::string out = "<svg class=\"force\" viewBox=\"-4 -14 " + fixed(force_width + 8.0, 0) + " " +
                      fixed(force_height + 30.0, 0) + "\" role=\"img\" font-size=\"12\"><line x1=\"0\" x2=\"" +
                      fixed(force_width, 0) + "\" y1=\"" + limit + "\" y2=\"" + limit +
                      "\" stroke=\"#d55e00\" stroke-dasharray=\"6 4\"/><text x=\"0\" y=\"" + fixed(y(1.0) - 4.0, 1) +
                      "\" fill=\"#d55e00\">force limit</text><polyline fill=\"none\" stroke=\"#000000\" points=\"";
    for (const TrialFrame& f : frames)
        out += fixed(force_width * (f.time_s - first) / span, 1) + "," + fixed(y(f.force_bar), 1) + " ";
    out += "\"/><line x1=\"0\" x2=\"" + fixed(force_width, 0) + "\" y1=\"" + fixed(force_height, 0) + "\" y2=\"" +
           fixed(force_height, 0) + "\" stroke=\"#808080\"/><text x=\"0\" y=\"" + fixed(force_height + 13.0, 0) +
           "\">" + fixed(first, 0) + " s</text><text x=\"" + fixed(force_width, 0) + "\" y=\"" +
           fixed(force_height + 13.0, 0) + "\" text-anchor=\"end\">" + fixed(frames.back().time_s, 0) +
           " s</text><line id=\"cursor\" y1=\"-10\" y2=\"" + fixed(force_height, 0) + "\" stroke=\"#0072b2\"/></svg>\n";
    return out;
}

/// The line in tenths of a mm: its first point, then steps from point to point, whose rounding does not add up.
std::string device_text(const std::vector<Vec3>& line) {
    std::string out = "[";
    std::array<long, 3> last{};
    for (const Vec3& p : line)
        for (Index axis = 0; axis < 3; ++axis) {
            const long now = std::lround(10.0 * p[axis]);
            out += std::to_string(now - last[static_cast<std::size_t>(axis)]) + ",";
            last[static_cast<std::size_t>(axis)] = now;
        }
    return out + "]";
}

std::string end_text(const CentrelineNode& node) {
    const Vec3& p = node.position;
    return fixed(p.x(), 1) + "," + fixed(p.y(), 1) + "," + fixed(p.z(), 1) + "," + fixed(node.radius, 1);
}

std::string data_text(const CentrelineGraph& vessels, std::span<const TrialFrame> frames, double device_mm) {
    std::string out = "const forceWidth = " + fixed(force_width, 0) + ", fieldMm = " + fixed(field_mm, 0) +
                      ", deviceMm = " + fixed(device_mm, 2) + ";\nconst vessels = [";
    for (const auto& [a, b] : vessels.edges) {
        const CentrelineNode& from = vessels.nodes[static_cast<std::size_t>(a)];
        const CentrelineNode& to = vessels.nodes[static_cast<std::size_t>(b)];
        const bool near = std::any_of(frames.begin(), frames.end(), [&](const TrialFrame& f) {
            return (f.tip - from.position).squaredNorm() < field_mm * field_mm;
        });
        if (near) out += "[" + end_text(from) + "," + end_text(to) + "],\n";
    }
    out += "];\nconst frames = [";
    for (const TrialFrame& f : frames)
        out += "[" + fixed(f.time_s, 2) + "," + fixed(f.tip.x(), 1) + "," + fixed(f.tip.y(), 1) + "," +
               fixed(f.tip.z(), 1) + "," + fixed(f.force_bar, 3) + "," + (f.beam_on ? "1" : "0") + "," +
               fixed(f.primary_deg, 1) + "," + fixed(f.secondary_deg, 1) + "," + device_text(f.device) + "],\n";
    return out + "];\n";
}

}  // namespace

std::string trial_page(const RunEntry& run, const CentrelineGraph& vessels, std::span<const TrialFrame> frames,
                       double device_mm, const std::string& verified, const std::string& report) {
    const std::string title =
        run.participant + " (" + run.group + "), task " + run.task + ", trial " + std::to_string(run.trial);
    std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
                      xml_escaped(title) + "</title>\n<style>" + style + "</style>\n</head>\n<body>\n<h1>" +
                      xml_escaped(title) + "</h1>\n<p><a href=\"" + xml_escaped(report) + "\">The report</a>";
    if (!verified.empty()) out += " &middot; " + xml_escaped(verified);
    out += "</p>\n";
    if (frames.empty()) return out + "<p>Nothing was recorded in this trial.</p>\n</body>\n</html>\n";
    out +=
        "<div class=\"views\">\n<figure><canvas id=\"beam\"></canvas><figcaption "
        "id=\"angles\"></figcaption></figure>\n" +
        view_of(0, "From the front: the patient's left is to the right", vessels, frames) +
        view_of(1, "From the patient's left: the back is to the right", vessels, frames) +
        "</div>\n<div class=\"controls\"><button id=\"play\">Play</button><input id=\"time\" type=\"range\" min=\"0\" "
        "max=\"" +
        std::to_string(frames.size() - 1) +
        "\" value=\"0\" aria-label=\"time\"><select id=\"pace\" aria-label=\"pace\"><option value=\"1\">1 x</option>"
        "<option value=\"4\" selected>4 x</option><option value=\"16\">16 x</option></select><output "
        "id=\"reading\"></output></div>\n" +
        force_plot(frames) + "<p>With its fluoroscopy, in the trainer: <code>cathlab play --replay " +
        xml_escaped(run.folder) + "</code>, from the study's folder. The vessels are drawn at rest" +
        (std::all_of(frames.begin(), frames.end(), [](const TrialFrame& f) { return f.device.empty(); })
             ? std::string(
                   ", and of the device its tip: the rest of it is known where the report was made with --verify")
             : std::string()) +
        ".</p>\n<script>\n" + data_text(vessels, frames, device_mm) + script + "</script>\n</body>\n</html>\n";
    return out;
}

}  // namespace cathlab
