// The trainer's turn, second half: where things stand, which pictures came, what the screens and the window show.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "play/play_app.h"

namespace cathlab::play {
namespace {

const char* side_title(Side side) {
    switch (side) {
        case Side::inner: return "inner view";
        case Side::displacement: return "from outside: displacement of the wall";
        case Side::force: return "from outside: force on the wall";
        case Side::kept: break;
    }
    return "kept picture";
}

}  // namespace

void PlayApp::make_fonts() {
    const float base = layout_.height / 640.0F * static_cast<float>(settings_.view.hud_scale);
    const float em = std::clamp(std::min({15.0F * base, layout_.width / 46.0F, layout_.height / 26.0F}), 8.0F, 64.0F);
    if (!ui_ || std::fabs(em - em_) > 0.5F) {
        em_ = em;
        ui_ = std::make_unique<UiContext>(em, true);
        ImGuiStyle& style = ImGui::GetStyle();
        style.ScaleAllSizes(std::max(0.5F, em / 14.0F));
        style.WindowRounding = 0.4F * em;
        style.FrameRounding = 0.25F * em;
        style.Colors[ImGuiCol_WindowBg].w = 1.0F;  // no letters behind letters
    }
    layout_.em = ui_->font_px();
    const auto column = layout_.width - static_cast<float>(layout_.fluoroscopy.width);
    const float scale = std::clamp(std::min(base, std::max(1.0F, column) / 230.0F), 0.5F, 4.0F);
    if (!hud_ || std::fabs(scale - hud_scale_) > 0.02F) {
        hud_scale_ = scale;
        hud_ = std::make_unique<Hud>(scale);
    }
}

void PlayApp::lay_out() {
    const int w = window_.width(), h = window_.height();
    layout_.width = static_cast<float>(w);
    layout_.height = static_cast<float>(h);
    const int side = std::min(h, static_cast<int>(0.6 * w));
    layout_.fluoroscopy = {0, (h - side) / 2, side, side};
    make_fonts();
    HudLayout hud;
    hud.width = layout_.width;
    hud.height = layout_.height;
    hud.split = static_cast<float>(side);
    hud.scale = hud_scale_;
    const float step = 17.0F * hud_scale_;
    const float bars = force_bar_rect(hud, std::max<std::size_t>(1, status_.panels.forces.size()), 0).y0;
    const auto free = static_cast<int>(bars - 2.6F * step - 4.0F * hud_scale_ - 3.4F * step);
    const int column = w - side;
    const int panel = std::min(std::max(0, free), static_cast<int>(11.6F * layout_.em));
    const int view = std::max(0, free - panel);
    layout_.side = view >= 64 && column >= 64 ? FrameRect{side, 0, column, view} : FrameRect{};
    layout_.panel = column >= 64 && panel >= 32 ? FrameRect{side, view, column, panel} : FrameRect{};
    layout_.foot = 5.2F * step;
    // Without a view, clock and title stand where it would be; their height is free below.
    if (layout_.side.width == 0 && layout_.panel.height > 0) layout_.panel.y += static_cast<int>(3.0F * step);
    if (!painter_) return;
    const auto most = static_cast<double>(settings_.view.largest_picture);
    PaintSizes sizes;
    sizes.width[0] = sizes.height[0] = std::max(64, std::min(side, static_cast<int>(most)));
    if (layout_.side.width > 0 && views_allowed() && side_ != Side::kept) {
        const std::size_t i = side_ == Side::inner ? 1 : 2;
        const double shrink = std::min(1.0, most / std::max(layout_.side.width, layout_.side.height));
        sizes.width[i] = std::max(64, static_cast<int>(shrink * layout_.side.width));
        sizes.height[i] = std::max(64, static_cast<int>(shrink * layout_.side.height));
    }
    painter_->wish(sizes);
}

void PlayApp::set_side(Side side) {
    side_ = side;
    const OuterMap map = side_ == Side::force ? OuterMap::force : OuterMap::displacement;
    if (sim_) sim_->between_steps([&](Simulation& simulation) { simulation.set_outer_map(map); });
}

void PlayApp::keep_picture() {
    if (fluoroscopy_.rgb.empty()) return;
    kept_ = fluoroscopy_;
    ++kept_revision_;
    side_ = Side::kept;
}

void PlayApp::next_side() {
    if (!views_allowed()) return;
    Side side = side_;
    do side = side == Side::kept ? Side::inner : static_cast<Side>(static_cast<int>(side) + 1);
    while (side == Side::kept && kept_.rgb.empty());
    set_side(side);
}

// Of which views a trial had the help: the inputs do not say.
void PlayApp::note_aids() {
    if (!sim_) return;
    const double now_s = status_.channels.time_s;
    if (layout_.side.width > 0 && views_allowed() && now_s > looked_until_s_)
        looked_s_[static_cast<std::size_t>(side_)] += now_s - looked_until_s_;
    looked_until_s_ = now_s;
}

// After the window was shown: what was commanded until the state that is in it has been answered.
void PlayApp::note_latency() {
    if (layout_.side.width == 0 || side_ == Side::kept) stamps_.clear();
    while (!stamps_.empty() && stamps_.front().first <= drawn_stamp_) {
        latency_s_ = std::chrono::duration<double>(Clock::now() - stamps_.front().second).count();
        latencies_.add(latency_s_);
        stamps_.erase(stamps_.begin());
    }
}

void PlayApp::take_pictures() {
    if (!painter_) return;
    if (const std::string fault = painter_->fault(); !fault.empty()) say(fault);
    std::uint64_t stamp = 0;
    if (painter_->take(View::fluoroscopy, fluoroscopy_, stamp)) {
        ++fluoroscopy_revision_;
        clip_.add(fluoroscopy_, status_.channels.time_s);
    }
    if (painter_->take(View::inner, inner_, drawn_stamp_)) ++inner_revision_;
    if (painter_->take(View::outer, outer_, drawn_stamp_)) ++outer_revision_;
}

void PlayApp::draw_screens(double dt) {
    input_.screens_begin();
    ui_->begin(layout_.width, layout_.height, static_cast<float>(dt), ui_feed_.take());
    if (screen_ == Screen::play) {
        PlayView view;
        view.status = status_;
        view.difficulty = setup_.difficulty;
        view.roadmap_allowed = roadmap_allowed();
        view.side_title = layout_.side.width == 0 ? "" : side_title(side_);
        view.hands_open = hands_open_;
        view.recording = status_.recording_fault.empty() && !loader_.folder().empty();
        view.replay = !options_.replay.empty();
        view.latency_ms = 1e3 * latency_s_;
        view.replay_s = static_cast<double>(status_.replay_steps) *
                        (status_.steps > 0 ? status_.channels.time_s / static_cast<double>(status_.steps) : 0.02);
        for (const Toast& toast : toasts_) view.toasts.push_back(toast.text);
        PlayWishes wishes;
        std::optional<std::int64_t> sought;
        wishes.press = [&](Control control) { input_.press(control); };
        wishes.hold = [&](Control control, double value) { input_.hold(control, value); };
        wishes.turn_to = [&](double primary, double secondary) {
            if (sim_) sim_->between_steps([&](Simulation& s) { s.pilot().turn_to(primary, secondary); });
        };
        wishes.acquire = [&](int what) {
            if (sim_) sim_->between_steps([&](Simulation& s) { s.pilot().acquire(what); });
        };
        wishes.set_level = [&](int level) {
            if (sim_) sim_->between_steps([&](Simulation& s) { s.pilot().set_level(level); });
        };
        wishes.open_to = [&](double width, double height) {
            if (sim_) sim_->between_steps([&](Simulation& s) { s.pilot().open_to(width, height); });
        };
        wishes.seek = [&](std::int64_t step) { sought = step; };
        draw_play(view, layout_, settings_.bindings, wishes);
        if (wishes.menu && panels_.empty()) open(Panel::pause);
        if (wishes.hands) hands_open_ = !hands_open_;
        if (sought) seek(*sought);
    }
    Wish wish = Wish::none;
    switch (panel()) {
        case Panel::pause: wish = draw_pause(layout_, paused_what()); break;
        case Panel::settings: wish = draw_settings(settings_, settings_view_, input_, layout_); break;
        case Panel::help: wish = draw_help(settings_.bindings, layout_); break;
        case Panel::none:
            if (screen_ == Screen::start) wish = draw_start(setup_, choices_, free_play_, context_.data_root, layout_);
            if (screen_ == Screen::loading) draw_loading(loader_.fraction(), loader_.what(), layout_);
            if (screen_ == Screen::result) wish = draw_result(result_, layout_);
            if (screen_ == Screen::study) wish = draw_study(study_view(), layout_);
            if (screen_ == Screen::questions) {
                wish = draw_questions(questions_, layout_);
                if (questions_.changed) keep_answers();
            }
            break;
    }
    if (screen_ != Screen::play) {
        PlayView view;
        for (const Toast& toast : toasts_) view.toasts.push_back(toast.text);
        ScreenLayout top = layout_;
        top.fluoroscopy = {0, 0, static_cast<int>(layout_.width), static_cast<int>(layout_.height + 5.3F * layout_.em)};
        top.panel = top.side = {};
        PlayWishes none;
        draw_play(view, top, settings_.bindings, none);
    }
    ui_->end(ui_list_);
    follow(wish);
}

void PlayApp::compose() {
    pictures_.clear();
    lists_.clear();
    if (screen_ == Screen::play) {
        pictures_.push_back({&fluoroscopy_, layout_.fluoroscopy, fluoroscopy_revision_});
        if (side_ == Side::kept) {
            const FrameRect& place = layout_.side;
            const int side = std::min(place.width, place.height);
            pictures_.push_back({&kept_, {place.x + (place.width - side) / 2, place.y, side, side}, kept_revision_});
        } else if (side_ == Side::inner) {
            pictures_.push_back({&inner_, layout_.side, inner_revision_});
        } else {
            pictures_.push_back({&outer_, layout_.side, outer_revision_});
        }
        HudData& panels = shown_panels_ = status_.panels;
        panels.running = !status_.paused;
        panels.high_contrast = settings_.view.palette == "high-contrast";
        panels.real_time_factor = status_.real_time_factor;
        HudLayout hud;
        hud.width = layout_.width;
        hud.height = layout_.height;
        hud.split = static_cast<float>(layout_.fluoroscopy.width);
        hud_->draw(panels, hud, hud_list_);
        lists_.push_back(&hud_list_);
    }
    lists_.push_back(&ui_list_);
}

Image8 PlayApp::picture_without_screens() {
    lists_.pop_back();
    Image8 out = picture();
    lists_.push_back(&ui_list_);
    return out;
}

void PlayApp::draw_window() {
    compose();
    window_.draw(pictures_, lists_);
    if (shot_wanted_) screenshot();
    window_.show();
    note_latency();
}

Image8 PlayApp::picture() {
    Image8 out;
    window_.draw(pictures_, lists_);
    window_.read(out);
    return out;
}

}  // namespace cathlab::play
