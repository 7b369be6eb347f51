// What happens when a control moves: all numbers and figures of the page follow.
// The values come from the page's element `content`; lube/explorer/content.py explains them.

const content = JSON.parse(document.getElementById("content").textContent);
const { levels, variables } = content;
const choices = Object.keys(levels);
const grid = ["force", "speed", "temperature"];
const units = {
    film_thickness: [1e6, "µm"],
    dynamic_viscosity: [1e3, "mPa s"],
    pressure_viscosity_coefficient: [1e9, "1/GPa"],
    contact_half_width: [1e6, "µm"],
    hertz_pressure: [1e-6, "MPa"],
    entrainment_speed: [1, "m/s"],
};
const axes = {
    force: "Force (N)",
    speed: "Speed (r/min)",
    temperature: "Temperature (°C)",
    slide_to_roll_ratio: "Slide-to-roll ratio",
};
const superscript = (power) => [...String(power)].map((c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join("");
const element = (id) => document.getElementById(id);

// Numbers as text

function rounded(number) {
    if (number === null) return "–";
    if (number === 0) return "0";
    if (Math.abs(number) >= 1e-4 && Math.abs(number) < 1e6) return String(Number(number.toPrecision(3)));
    const [digits, power] = number.toExponential(2).split("e");
    return `${Number(digits)} × 10${superscript(Number(power))}`;
}

const percent = (share) => (share === null ? "–" : `${rounded(100 * share)}\u00a0%`);

// Values at an operating point, which is an index for each choice

function at(name, point, among = variables) {
    const variable = among[name];
    const place = (sum, dim) => sum * levels[dim].values.length + point[dim];
    return variable.values[variable.dims.reduce(place, 0)];
}

function shown(name, point) {
    const [factor, unit] = units[name] ?? [1, ""];
    const value = at(name, point);
    return value === null ? "–" : `${rounded(factor * value)}\u00a0${unit}`.trim();
}

const named = (point, names) => names.map((name) => levels[name].names[point[name]]).join(", ");

const isSurface = (point) => levels.contact_model?.values[point.contact_model] === "surface";

// The probability by importance sampling, if the study has it, else counted in its realisations,
// which are pairs of lines.
function probability(point, kind = "breakthrough") {
    const sampled = limits(`tail.${kind}_probability`, ["", "_lower", "_upper"], point);
    if (sampled.mean !== null) return { ...sampled, seen: true, text: percent(sampled.mean) };
    return isSurface(point) ? { ...sampled, seen: false, text: "–" } : counted(point, kind);
}

function counted(point, kind = "breakthrough") {
    const found = limits(`${kind}_probability`, ["_mean", "_lower", "_upper"], point);
    const seen = found.mean > 0;
    return { ...found, seen, text: seen ? percent(found.mean) : `<\u00a0${percent(found.upper)}` };
}

function limits(name, endings, point) {
    const [mean, lower, upper] = endings.map((ending) => at(`${name}${ending}`, point));
    return { mean, lower, upper };
}

const withInterval = ({ text, seen, lower, upper }) => (seen ? `${text} (${percent(lower)} to ${percent(upper)})` : text);

// Where the model cannot hold, or contact falls as the film thins
const marks = {
    overloaded: "outside the model: the asperities would carry more than the load",
    merged: "less contact than at a thicker film: the layer of merged segments holds",
    deformed: "the oil changes the roughness by too large a part of the film: the linear response is not valid",
    separated: "lambda ratio of 2.5 or more: the oil may keep lines apart that touch by its linear response",
    rubbing: "asperities of the surfaces carry more than a tenth of the load: the film is less certain",
};
const ofLines = ["overloaded", "merged", "separated"];
const isMarked = (name, point) => !(ofLines.includes(name) && isSurface(point)) && at(name, point, content.marks);
const marked = (point) => Object.keys(marks).filter((name) => isMarked(name, point));

// One row of a source of operating points
function row(point, along) {
    const found = probability(point);
    const { mean, lower, upper } = found;
    const seen = mean > 0;
    return {
        ...point,
        x: along ? levels[along].values[point[along]] : NaN,
        film: 1e6 * at("film_thickness", point),
        mean: positive(mean),
        lower: seen ? Math.max(lower, 1e-30) : NaN, // the axis ends far above
        upper: seen ? upper : NaN,
        limit: seen ? NaN : positive(upper),
        lambda: at("lambda_ratio", point),
        width: 2e6 * at("contact_half_width", point),
        M: at("moes_load", point),
        L: at("moes_material", point),
        outside: isMarked("overloaded", point) ? positive(mean) : NaN,
        falling: isMarked("merged", point) ? positive(mean) : NaN,
        deformed: isMarked("deformed", point) ? positive(mean) : NaN,
        separated: isMarked("separated", point) ? positive(mean) : NaN,
        rubbing: isMarked("rubbing", point) ? positive(mean) : NaN,
        name: [`${named(point, grid)}: ${withInterval(found)}`, ...marked(point).map((name) => marks[name])].join("; "),
    };
}

// Points that differ from a point in some choices
function* neighbours(point, names) {
    if (!names.length) {
        yield point;
        return;
    }
    const [name, ...rest] = names;
    for (const index of levels[name].values.keys()) yield* neighbours({ ...point, [name]: index }, rest);
}

// A logarithmic axis cannot show zero.
const positive = (share) => (share > 0 ? share : NaN);

function fill(source, rows) {
    const columns = Object.keys(source.data);
    source.data = Object.fromEntries(columns.map((name) => [name, rows.map((one) => one[name] ?? NaN)]));
}

// Controls

function chosen(controls) {
    const index = (name) => (name in controls ? levels[name].names.indexOf(controls[name].value) : 0);
    return Object.fromEntries(choices.map((name) => [name, index(name)]));
}

function choose(controls, point) {
    for (const name of choices) {
        if (name in controls) controls[name].value = levels[name].names[point[name]];
    }
}

// The page's address names the point, so that a link to the point can be kept.

function fromAddress(controls) {
    for (const [name, value] of new URLSearchParams(location.hash.slice(1))) {
        const index = levels[name]?.values.findIndex((level) => String(level) === value) ?? -1;
        if (index >= 0 && name in controls) controls[name].value = levels[name].names[index];
    }
}

function toAddress(controls, point) {
    const names = choices.filter((name) => name in controls);
    const words = new URLSearchParams(names.map((name) => [name, levels[name].values[point[name]]]));
    history.replaceState(null, "", `#${words}`);
}

// Parts of the page

function showAnswers(point) {
    const { lower, upper, seen, text } = probability(point);
    element("probability").textContent = text;
    const unseen = isSurface(point)
        ? "not known, because the film is not"
        : "of the time: no contact was seen; 95 % upper limit";
    element("interval").textContent = seen ? `of the time; 95 % interval ${percent(lower)} to ${percent(upper)}` : unseen;
    element("bands").textContent = bands(point);
    element("marks").textContent = marked(point).map((name) => marks[name]).join("; ");
    if (content.sampled) {
        const rate = limits("tail.breakthrough_rate", ["", "_lower", "_upper"], point);
        const [often, least, most] = [rate.mean, rate.lower, rate.upper].map((one) => rounded(3600 * one));
        element("rate").textContent =
            rate.mean === null ? "" : `${often} breakthroughs per hour (${least} to ${most}), on average over pairs of rollers`;
    }
    element("film").textContent = shown("film_thickness", point);
    const valid = at("in_validity_range", point);
    element("valid").textContent = `${at("formula_place", point)} film, ${valid ? "within" : "outside"} the formula's validated range`;
    element("valid").classList.toggle("warning", !valid);
    element("lambda").textContent = shown("lambda_ratio", point);
    element("regime").textContent = content.regimes[at("regime", point)].replace("_", ", ");
}

// The assumptions are nearest to pure rolling, by the study's first contact model and film formula if
// these are not among what is open
const slips = levels.slide_to_roll_ratio.values.map(Math.abs);
const rolling = slips.lastIndexOf(Math.min(...slips));
const isAssumed = (point) =>
    point.slide_to_roll_ratio === rolling && ["contact_model", "film_formula"].every((name) => !point[name] || content.factors.includes(name));

// What one pair may show in a revolution, and what means over pairs the assumptions allow
function bands(point) {
    const both = content.factors.includes("contact_model") ? " of lines and surfaces" : "";
    const words = {
        breakthrough_probability_pair: ["one pair, 95 %: ", !isSurface(point)],
        surface_pair: ["one pair, 95 %: ", isSurface(point)],
        "sensitivity.breakthrough_probability": [`assumptions, 5 to 95 % of means${both}: `, isAssumed(point)],
    };
    const texts = Object.entries(words).map(([name, [text, isKnown]]) => {
        if (!isKnown || !(`${name}_lower` in variables)) return "";
        const { mean: lower, lower: upper } = limits(name, ["_lower", "_upper"], point);
        return lower === null ? "" : `${text}${percent(lower)} to ${percent(upper)}`;
    });
    return texts.filter(Boolean).join("; ");
}

function isNear(record, point, names) {
    const level = (name) => levels[name].values[point[name]];
    return (
        record.lubricant === level("lubricant") &&
        record.slide_to_roll_ratio === level("slide_to_roll_ratio") &&
        names.every((name) => record[`${name}_level`] === level(name))
    );
}

const origin = content.records.origin.replace(/^./, (first) => first.toUpperCase());

function recordText(record, point) {
    const { measured_share: share, measured_share_lower: lower, measured_share_upper: upper } = record;
    const { by_model: byModel } = content.records;
    const predicted = [record.predicted_share_lower, record.predicted_share_upper].map(
        (limits) => (byModel ? limits[point.contact_model] : limits)[point.film_formula],
    );
    const isOfLines = levels.contact_model && !(byModel && isSurface(point));
    const text = `${origin} record ${record.record}: in contact ${percent(share)} of the time (${percent(lower)} to ${percent(upper)})`;
    if (predicted.includes(null)) return text;
    return `${text}; predicted for one pair of ${isOfLines ? "lines" : "rollers"}: ${predicted.map(percent).join(" to ")}`;
}

function showRecords(point, along, source) {
    const here = content.records.rows.filter((record) => isNear(record, point, grid));
    const lines = here.map((record) => {
        const line = document.createElement("p");
        line.className = "note";
        line.textContent = recordText(record, point);
        return line;
    });
    element("records").replaceChildren(...lines);
    // The figures show records that differ in the abscissa alone, or that have the chosen force.
    const others = grid.filter((name) => name !== along);
    fill(
        source,
        content.records.rows
            .filter((record) => isNear(record, point, []))
            .map((record) => ({
                name: recordText(record, point),
                share: positive(record.measured_share),
                x: grid.includes(along) && isNear(record, point, others) ? record[along] : NaN,
                lambda: isNear(record, point, ["force"]) ? record.lambda_ratio[point.film_formula] : NaN,
            })),
    );
}

function showMaster(point, source) {
    if (content.master === null) return; // contact depends on more than the film thickness and the width
    element("master-key").hidden = isSurface(point); // the map is of lines
    if (isSurface(point)) {
        fill(source, []);
        return;
    }
    const { lambda_ratio, contact_width, mean, lower, upper } = content.master;
    const width = 2 * at("contact_half_width", point);
    const away = contact_width.map((one) => Math.abs(one - width));
    const near = away.indexOf(Math.min(...away));
    const last = contact_width.length - 1;
    fill(
        source,
        lambda_ratio.map((lambda, i) => ({
            lambda,
            narrow: positive(mean[0][i]),
            wide: positive(mean[last][i]),
            near: positive(mean[near][i]),
            lower: mean[near][i] > 0 ? Math.max(lower[near][i], 1e-30) : NaN,
            upper: mean[near][i] > 0 ? upper[near][i] : NaN,
        })),
    );
    const text = (index) => `${rounded(1e6 * contact_width[index])} µm`;
    element("near-width").textContent = text(near);
    if (last > 0) {
        element("narrow-width").textContent = text(0);
        element("wide-width").textContent = text(last);
    }
}

function setRange(range, values, room) {
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const more = room * (high - low) || 0.5;
    [range.start, range.end] = [low - more, high + more];
}

function traceText(trace) {
    const crossing = `An asperity takes ${rounded(1e3 * trace.crossing)} ms to cross the contact. `;
    if (!trace.close) {
        return (
            `One pair of surfaces, followed over ${rounded(1e3 * trace.way)} mm of rolling: they touch at ${rounded(trace.contacts)} ` +
            `places at once on average, and ${percent(trace.share)} of this time a boundary layer is broken. ${crossing}` +
            `Drawn, of contacts with a broken layer: the sum of their diameters${content.conducts ? ", and their resistance in parallel" : ""}.`
        );
    }
    const close = trace.close.steps > 1 ? `within every ${trace.close.steps}` : "in every step";
    return (
        `One realisation of the roughness, in contact ${percent(trace.share)} of this revolution. ${crossing}` +
        `Drawn: the longest contact${content.conducts ? " and the lowest resistance" : ""} ` +
        `within every ${trace.whole.steps} time steps, and around the peak ${close}.`
    );
}

function showTrace(point, sources, figures) {
    const trace = content.traces.find((one) => choices.every((name) => one.at[name] === point[name]));
    element("traces").hidden = trace === undefined;
    element("trace-points").hidden = trace !== undefined;
    if (trace === undefined) {
        element("trace-text").textContent = "The study kept no trace at this point, but at these:";
        return;
    }
    element("trace-text").textContent = traceText(trace);
    element("whole-title").textContent = trace.close ? "One revolution" : "All contacts along the rollers";
    element("close-up").hidden = !trace.close;
    const { time, contact_length } = trace.close ?? trace.whole;
    const peak = time[contact_length.indexOf(Math.max(...contact_length))];
    const parts = trace.close ? [["whole", 1, 0], ["close", 1e3, peak]] : [["whole", 1e3, 0]];
    for (const [part, scale, zero] of parts) {
        const { time, contact_length, contact_resistance } = trace[part];
        const rows = time.map((moment, i) => ({
            time: scale * (moment - zero),
            length: 1e6 * contact_length[i],
            resistance: contact_resistance[i],
        }));
        fill(sources[part], rows);
        for (const name of [`${part}_length`, `${part}_resistance`].filter((name) => name in figures)) {
            setRange(figures[name].x_range, rows.map((one) => one.time), 0.01);
            if (part === "whole") figures[name].below[0].axis_label = trace.close ? "Time (s)" : "Time (ms)";
        }
        figures[`${part}_length`].y_range.setv({ start: 0, end: 1.08 * Math.max(...rows.map((one) => one.length)) || 1 });
    }
}

function showTable(id, rows) {
    const line = (cells) => {
        const made = document.createElement("tr");
        made.append(...cells.map((text) => Object.assign(document.createElement("td"), { textContent: text })));
        return made;
    };
    element(id).replaceChildren(...rows.map(line));
}

function showValues(point) {
    const rows = [
        "dynamic_viscosity",
        "pressure_viscosity_coefficient",
        "entrainment_speed",
        "hertz_pressure",
        "moes_load",
        "moes_material",
    ].map((name) => [variables[name].long_name, shown(name, point)]);
    rows.splice(4, 0, ["contact width", `${rounded(2e6 * at("contact_half_width", point))} µm`]);
    const heating = at("inlet_shear_heating_factor", point);
    const applied = content.is_heated ? "" : ", not applied";
    rows.push([`film reduction by inlet shear heating${applied}`, percent(heating === null ? null : 1 - heating)]);
    if (content.sampled && !isSurface(point)) {
        rows.push(["breakthroughs counted in the realisations", withInterval(counted(point))]);
    }
    const share = isSurface(point) ? "surface_load_share" : "contact_load_share";
    if (share in variables) rows.push([variables[share].long_name, shown(share, point)]);
    rows.push(["geometric contact probability", probability(point, "geometric_contact").text]);
    showTable("values", rows.map(([name, value]) => [name[0].toUpperCase() + name.slice(1), value]));
    showTable(
        "digits",
        Object.entries(variables).map(([name, { units, file }]) => [
            name,
            String(at(name, point)),
            units === "1" ? "" : units,
            file,
        ]),
    );
    const words = choices.map((name) => `${name}=${JSON.stringify(levels[name].values[point[name]])}`);
    const [file, variable] = content.sampled ? ["tail", "probability"] : ["contact", "probability_mean"];
    element("python").textContent =
        `import xarray as xr\n\n${file} = xr.open_dataset("results/${content.study}/${file}.nc")\n` +
        `point = ${file}.sel(${words.join(", ")})\npoint.breakthrough_${variable}`;
}

function prepareTraceButtons(controls) {
    const buttons = content.traces.map((trace) => {
        const button = document.createElement("button");
        const several = ["lubricant", "film_formula", "contact_model"].filter((name) => name in controls);
        button.textContent = named(trace.at, [...grid, ...several]);
        button.addEventListener("click", () => choose(controls, trace.at));
        return button;
    });
    element("trace-points").replaceChildren(...buttons);
}

let ready = false;

export default function ({ controls, sources, figures }, origin) {
    const tapped = ["along", "grid", "force"].find((name) => sources[name].selected === origin);
    if (tapped !== undefined) {
        const [index] = origin.indices;
        if (index === undefined) return;
        const data = sources[tapped].data;
        const point = Object.fromEntries(choices.map((name) => [name, data[name][index]]));
        origin.indices = [];
        choose(controls, point); // which calls this function again
        return;
    }
    if (!ready) {
        ready = true;
        fromAddress(controls);
        prepareTraceButtons(controls);
    }
    const point = chosen(controls);
    const along = "along" in controls ? controls.along.tags[controls.along.active] : "temperature";
    setRange(figures.film.x_range, levels[along].values, 0.06); // the range of both figures
    for (const name of ["film", "probability"]) figures[name].below[0].axis_label = axes[along];
    fill(sources.along, [...neighbours(point, [along])].map((one) => row(one, along)));
    fill(sources.grid, [...neighbours(point, grid)].map((one) => row(one)));
    fill(sources.force, [...neighbours(point, ["speed", "temperature"])].map((one) => row(one)));
    fill(sources.chosen, [row(point, along)]);
    const { moes_load, moes_material } = content.validity[levels.film_formula.values[point.film_formula]];
    fill(sources.frame, [{ left: moes_load[0], right: moes_load[1], bottom: moes_material[0], top: moes_material[1] }]);
    showAnswers(point);
    showRecords(point, along, sources.records);
    showMaster(point, sources.master);
    showValues(point);
    showTrace(point, sources, figures);
    toAddress(controls, point);
}
