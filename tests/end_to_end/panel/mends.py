"""The twenty defects of the operator page, and their mends, each undone by replacing one text of one file. `test`: the program
that must go red; `check`: which of its checks."""
from dataclasses import dataclass

PAGE = "hmi/web/tests/browser/truths_test.mjs"
TRUTHS = "tests/end_to_end/panel/truths.mjs"
AMBER = "tests/end_to_end/panel/amber_walls.mjs"
SRC = "hmi/web/src/"

DEFECTS = {
    "1": "Stop dead while a card is open", "2": "a speed that is the command", "3": "values of silent devices without an age",
    "4": "no PIN field after a server restart; Stop without a session", "5": "what became of a said place, and why, is not shown",
    "6": "operators cannot say where the vehicle is", "7": "another drawing replaces all without a question",
    "8": "a lost vehicle drawn at (0,0)", "9": "\"It failed.\"", "10": "faulty legs ticked and not marked; orders queued that cannot be served",
    "11": "jog buttons below the fold", "12": "buttons that jump under the finger", "13": "\"press Resume\" while lost",
    "14": "drives off when its place is said", "15": "an order's buttons below the fold", "16": "Stop does not say what it ended",
    "17": "placeholders in the statistics", "18": "standing walls amber", "19": "jargon; English in other languages", "20": "no map on a phone",
}


@dataclass
class Mend:
    number: str
    undone: str  # what the mutation does, in words
    file: str
    text: str
    instead: str
    test: str
    check: str


MENDS = [
    Mend("1", "a card makes the command bar inert too", SRC + "ui/above_page.tsx", '(".rail, .page")', '(".rail, .page, .command-bar")', TRUTHS, "1, 16"),
    Mend("2", "the speed is the command", "app/panel/live_copy.cpp",
         "VelocityCommand{state.odometry.linear_mps(), state.odometry.angular_radps()}", "state.limits.previous", TRUTHS, "2"),
    Mend("3", "a gauge never grows old", SRC + "ui/gauges.tsx", "props.age > STALE_S;", "props.age > 1e9 * STALE_S;", TRUTHS, "3"),
    Mend("3", "the scan never grows old", SRC + "pages/drive.tsx", 'heardAgo(shown, "lidar", age) <= STALE_S;', 'heardAgo(shown, "lidar", age) >= 0;', PAGE, "3"),
    Mend("3", "the silent devices are not named", SRC + "ui/state_card.tsx", '!device.healthy && device.type !== "link"', "device.age_s < 0", TRUTHS, "3"),
    Mend("4", "nobody asks for the PIN after a restart", SRC + "main.tsx",
         "pinWanted.tell = askWho;\n    const unwatch = live.lost.watch(askWho);", "pinWanted.tell = () => void askWho;\n    const unwatch = live.lost.watch(() => undefined);", TRUTHS, "4"),
    Mend("4", "a Stop without a session is not sent again", SRC + "ui/stop.ts", "kGiveUp_ms = 60_000", "kGiveUp_ms = 1", TRUTHS, "4"),
    Mend("5", "what became of the word is not said", SRC + "ui/where_card.tsx", "{said && <Said />}", "{said && false && <Said />}", TRUTHS, "5, 6"),
    Mend("5", "walls that contradict are not marked", SRC + "map/contradictions.ts", ">= kLeastBeams &&", ">= 1e9 * kLeastBeams &&", TRUTHS, "5, 6"),
    Mend("6", "only an integrator may say the place", SRC + "pages/drive.tsx",
         '<button type="button" class="target where-button" aria-pressed={asking} onClick={() => setAsking(!asking)}><Icon name="pin" /> {t("where.title")}</button>',
         '{role === "integrator" && <button type="button" class="target where-button" aria-pressed={asking} onClick={() => setAsking(!asking)}><Icon name="pin" /> {t("where.title")}</button>}',
         TRUTHS, "4"),
    Mend("7", "another building's drawing takes the site's place at once", SRC + "pages/setup/another_drawing.tsx", "setAsks(another);",
         "if (another && file) replace(file);", TRUTHS, "7"),
    Mend("8", "a lost vehicle stays on the map", SRC + "pages/drive.tsx", 'const known = shown.live.drivable && shown.live.pose.health !== "LOST";',
         "const known = shown.live.drivable;", PAGE, "8"),
    Mend("9", "the kind of failure is not sent", "hmi/server/import_request.cpp", "if (reason.find(says) != std::string::npos) return kind;",
         "if (reason.find(says) == 0) return kind;", TRUTHS, "9"),
    Mend("10", "an order that cannot be served is queued", "app/panel/panel_vehicle.cpp", "if (const auto station = run_.without_way(after, nodes, repeat > 1)) {",
         "if (const auto station = run_.without_way(after, nodes, repeat > 1); station && nodes.empty()) {", TRUTHS, "10"),
    Mend("10", "faulty legs are not marked", SRC + "map/factory_map.ts", 'setAttribute("data-faulty", [...faulty].join(" "));', 'setAttribute("data-faulty", ""); faulty = new Set();', TRUTHS, "10"),
    Mend("10", "the step keeps its tick", "hmi/server/site_editor_setup.cpp", "return {kFaultyLegs,", "if (parsed.graph.nodes().empty()) return {kFaultyLegs,", TRUTHS, "10"),
    Mend("11", "the hint stands above the buttons", SRC + "ui/jog.tsx", '<section class="jog-card">', '<section class="jog-card"><p>{t("drive.jog.hint")}</p>', PAGE, "11"),
    Mend("12", "the state card is as high as its words", SRC + "styles.css", ".state { height: calc(1.72 * var(--target));", ".state {", PAGE, "12"),
    Mend("13", "paused says Resume, whatever is known", "app/cycle/standstill.cpp",
         "if (state.lidar_heard && !may_drive(state.pose.health.state)) return why_unplaced(state, now);", "", TRUTHS, "8, 13"),
    Mend("14", "a place that is said does not pause", "app/panel/panel_vehicle.cpp",
         "run_.say({OperatorWord::Pause, {}, {}});\n  const GivenPose given{map_from_base.translation(), map_from_base.yaw_rad(), PoseSigma{}};",
         "const GivenPose given{map_from_base.translation(), map_from_base.yaw_rad(), PoseSigma{}};", TRUTHS, "14"),
    Mend("15", "the buttons of an order open where they are", SRC + "ui/orders_card.tsx", ' ref={tools}>', ">", PAGE, "15"),
    Mend("16", "Stop does not say what it ended", "app/cycle/mode_stage.cpp", "if (word == OperatorWord::Stop && state.way.target) state.stopped_order",
         "if (!state.stopped && state.way.target) state.stopped_order", TRUTHS, "1, 16"),
    Mend("17", "causes are summed under their full sentence", SRC + "notice_text.ts", "[`kind.${cause.code}`, `cause.${cause.code}`]", "[`cause.${cause.code}`]", PAGE, "17"),
    Mend("18", "what passes beside a wall passes through it", "localization/wall_reliability/wall_looks.cpp", "sight->through = fan_of(*sure, sensor_, 0.0);",
         "sight->through = sight->fan;\n    else\n      sight->through = sight->fan;", AMBER, ""),
    Mend("19", "faults are not translated", SRC + "notice_text.ts", '...translated(t, values, "faults", "fault", ", ")', '', PAGE, "19"),
    Mend("19", "the vehicle's English stands in other languages", SRC + "notice_text.ts", 'language.value !== "en" && wanted', 'language.value === "none" && wanted', PAGE, "19"),
    Mend("20", "a phone gets the page of a panel", SRC + "styles.css", "@media (max-width: 700px) {", "@media (max-width: 1px) {", PAGE, "20"),
]
