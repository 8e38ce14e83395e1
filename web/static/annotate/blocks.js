// Blockly: an action is a block with slots, a thing fits only into slots whose action can be done to it.

import PHRASES from "/phrases.js";

const NARROW = innerWidth < 700; // then the drawers stand above the program

const HUES = {
  "Go": "#3b6fb6", "Sit, lie, stand": "#7a5ca8", "Take and put": "#b0661f", "Open and switch": "#2f7d57",
  "Dress": "#a8487a", "Look": "#4d7f8c", "By hand": "#8a6d1c", "Other": "#6b6b6b",
};
const THING = "#5b4b3f";
const SPECIAL = "#9a3030";

// The policy of the server forbids style elements; sheets that are adopted are allowed.
function withAdoptedStyles(work) {
  const create = document.createElement;
  document.createElement = function (name, ...rest) {
    const isStyle = String(name).toLowerCase() === "style";
    const made = create.call(document, isStyle ? "template" : name, ...rest);
    if (isStyle) {
      Object.defineProperty(made, "textContent", {
        set(text) {
          const sheet = new CSSStyleSheet();
          sheet.replaceSync(text);
          document.adoptedStyleSheets.push(sheet);
        },
      });
    }
    return made;
  };
  try { return work(); } finally { document.createElement = create; }
}

// The text of a bubble, without the style attribute that the policy forbids; its words run as the page's.
function plainBubbles() {
  const { Bubble, TextBubble } = Blockly.bubbles;
  TextBubble.prototype.createParagraph = (inside) => Blockly.utils.dom.createSvgElement("g", {
    class: "blocklyText blocklyBubbleText blocklyNoPointerEvents", transform: `translate(0,${Bubble.BORDER_WIDTH})`,
  }, inside);
}

const typeOf = (action) => `act ${action}`;
const thingType = (ref) => `thing ${ref[0]} ${ref[1]}`;

function define(model) {
  const made = [{
    type: "start", message0: "The program", nextStatement: null, colour: "#2b2b2b",
    tooltip: "Steps stand below this block, in their order.",
  }, {
    type: "special", message0: "Special: %1", args0: [{ type: "field_input", name: "TEXT", text: "" }],
    previousStatement: null, nextStatement: null, colour: SPECIAL, tooltip: "What no other block says, in your words.",
  }];
  for (const action of model.actions.values()) {
    made.push({
      type: typeOf(action.name),
      message0: action.words.replace(/\{(\d)\}/g, (_, slot) => `%${Number(slot) + 1}`)
        + (action.runs ? "" : ` ${PHRASES.annotate.cannot_run}`),
      args0: action.slots.map((slot, number) => ({ type: "input_value", name: `S${number}`, check: slot })),
      inputsInline: true, previousStatement: null, nextStatement: null,
      colour: HUES[action.drawer] ?? HUES.Other,
      tooltip: action.runs ? "" : PHRASES.annotate.cannot_run_note,
    });
  }
  for (const thing of model.things) {
    made.push({
      type: thingType([thing.name, thing.instance]), message0: thing.words, output: thing.fits.length ? thing.fits : "none",
      colour: THING,
    });
  }
  for (const each of made) delete Blockly.Blocks[each.type];
  Blockly.defineBlocksWithJsonArray(made);
}

function toolbox(model) {
  const drawers = new Map();
  for (const action of model.actions.values()) {
    const possible = action.slots.every((slot) => model.things.some((thing) => thing.fits.includes(slot)));
    if (!possible) continue;
    if (!drawers.has(action.drawer)) drawers.set(action.drawer, []);
    drawers.get(action.drawer).push({ kind: "block", type: typeOf(action.name) });
  }
  const things = model.things.map((thing) => ({ kind: "block", type: thingType([thing.name, thing.instance]) }));
  const category = (name, colour, contents) => ({ kind: "category", name, colour, contents });
  return {
    kind: "categoryToolbox",
    contents: [
      category("Things", THING, things),
      ...Object.keys(HUES).filter((name) => drawers.has(name)).map((name) => category(name, HUES[name], drawers.get(name))),
      category("Special", SPECIAL, [{ kind: "block", type: "special" }]),
    ],
  };
}

function asBlocks(steps) {
  let next;
  for (const step of [...steps].reverse()) {
    const block = "special" in step
      ? { type: "special", fields: { TEXT: step.special } }
      : { type: typeOf(step.action), inputs: {} };
    if (!("special" in step)) {
      step.things.forEach((ref, number) => { if (ref) block.inputs[`S${number}`] = { block: { type: thingType(ref) } }; });
    }
    if (next) block.next = { block: next };
    next = block;
  }
  return { type: "start", x: NARROW ? 12 : 260, y: NARROW ? 96 : 24, deletable: false, movable: false, ...(next ? { next: { block: next } } : {}) };
}

function chain(workspace) {
  const found = [];
  for (let block = workspace.getBlocksByType("start")[0]?.getNextBlock(); block; block = block.getNextBlock()) found.push(block);
  return found;
}

function asStep(block) {
  if (block.type === "special") return { special: block.getFieldValue("TEXT").trim() };
  const slots = block.inputList.filter((input) => input.connection);
  const things = slots.map((input) => {
    const [, name, instance] = input.connection.targetBlock()?.type.split(" ") ?? [];
    return name ? [name, Number(instance)] : null;
  });
  return { action: block.type.split(" ")[1], things };
}

function theme() {
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  return Blockly.Theme.defineTheme(dark ? "hearth-dark" : "hearth-light", {
    base: Blockly.Themes.Zelos,
    fontStyle: { family: "system-ui, 'DejaVu Sans', sans-serif", size: 11 },
    componentStyles: dark
      ? { workspaceBackgroundColour: "#1f1c1a", toolboxBackgroundColour: "#2b2724", toolboxForegroundColour: "#efebe5",
          flyoutBackgroundColour: "#332e2a", flyoutForegroundColour: "#efebe5", flyoutOpacity: 1, scrollbarColour: "#6b635a" }
      : { workspaceBackgroundColour: "#ffffff", toolboxBackgroundColour: "#f1ece6", toolboxForegroundColour: "#1f1d1b",
          flyoutBackgroundColour: "#e8e1d8", flyoutForegroundColour: "#1f1d1b", flyoutOpacity: 1, scrollbarColour: "#b5aca1" },
  });
}

// Show the program as blocks in an element; `changed` gets the steps after each change by hand, `loose` the number of
// blocks that hang on nothing.
export function mount(element, model, changed, loose) {
  plainBubbles();
  define(model);
  const workspace = withAdoptedStyles(() => Blockly.inject(element, {
    toolbox: toolbox(model), media: "/fetched/blockly/media/", renderer: "zelos", theme: theme(), sounds: false,
    trashcan: true, scrollbars: true, zoom: { controls: false, wheel: false, startScale: NARROW ? 0.7 : 0.8 },
    maxTrashcanContents: 0, horizontalLayout: NARROW,
    collapse: false, comments: false, disable: false, // the program has no place for these
  }));
  let last = "";
  let later = 0;
  const marked = new WeakMap();
  workspace.addChangeListener((event) => {
    if (event.isUiEvent || workspace.isDragging()) return;
    loose(workspace.getTopBlocks().length - 1);
    const steps = chain(workspace).map(asStep);
    if (JSON.stringify(steps) === last) return;
    last = JSON.stringify(steps);
    changed(steps);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => withAdoptedStyles(() => workspace.setTheme(theme())));
  return {
    workspace,
    show(steps) {
      last = JSON.stringify(steps);
      loose(0);
      Blockly.Events.disable();
      try {
        Blockly.serialization.workspaces.load({ blocks: { languageVersion: 0, blocks: [asBlocks(steps)] } }, workspace);
      } finally { Blockly.Events.enable(); }
    },
    mark(found) {
      clearTimeout(later);
      if (workspace.isDragging()) {  // a block that changes its size would shake off the one that is being put to it
        later = setTimeout(() => this.mark(found), 200);
        return;
      }
      chain(workspace).forEach((block, number) => {
        const mine = found.filter((each) => each.step === number);
        const text = mine.map((each) => (each.remedy ? `${each.message}: ${each.remedy}` : each.message)).join("\n");
        if ((marked.get(block) ?? "") !== text) block.setWarningText(text || null);
        marked.set(block, text);
        block.getSvgRoot().classList.toggle("faulty", mine.some((each) => each.fault));
      });
    },
    fit() {
      Blockly.svgResize(workspace);
      workspace.scroll(0, 0);  // the drawers open beside the program, not over it
    },
  };
}
