--- The I/O panel of a program that is simulated, or monitored in a PLC: a buffer with lamps, switches by keys and a timing chart.
local bases = require('rungwise.bases')
local chart = require('rungwise.chart')
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

local SPACE = vim.api.nvim_create_namespace('rungwise_panel')
--- The chart is asked for no more often, and the window is told when it stands still.
local CHART_MS, SCROLL_MS = 100, 50
--- More signals are charted only if they are chosen.
local FIRST_SIGNALS = 8
--- Values begin in this column, or behind the longest name, but for names that are longer than is of use.
local LABEL, LABEL_MAX = 12, 40
--- Milliseconds in a column of the chart of a PLC, to begin with.
local PLC_SCANS = 100

--- The panels, by the buffer of the panel.
local panels = {}

for name, link in pairs({
  RungwiseLampOn = 'DiagnosticOk', RungwiseLampOff = 'NonText', RungwiseForced = 'DiagnosticWarn',
  RungwiseGroup = 'Title', RungwiseChartOn = 'RungwiseLampOn', RungwiseChartWord = 'Number',
}) do
  vim.api.nvim_set_hl(0, name, { default = true, link = link })
end

local function group_title(group)
  local titles = {
    inputs = t('Inputs'), outputs = t('Outputs'), timers = t('Timers'), counters = t('Counters'), states = t('States'),
    relays = t('Relays'), registers = t('Registers'), variables = t('Variables'),
  }
  return titles[group] or group
end

--- The column in which values and the chart begin: behind blanks, a lamp and the name.
local function label_width(panel)
  local width = LABEL
  for _, row in pairs(panel.by_name) do
    width = math.max(width, vim.fn.strdisplaywidth(row.label) + 5)
  end
  return math.min(width, LABEL_MAX)
end

--- A value as people read it: times of timers in seconds.
local function reading(row, value)
  if type(value) ~= 'number' or not row.unit_ms then
    return tostring(value)
  end
  return ('%%.%df s'):format(row.unit_ms >= 100 and 1 or row.unit_ms >= 10 and 2 or 3):format(value * row.unit_ms / 1000)
end

--- The text of a row, and its highlights as { first byte, byte behind, group }.
local function row_line(panel, row)
  local own = panel.values[row.name]
  local contact = row.contact and panel.values[row.contact]
  local lit = own
  if row.contact then
    lit = contact
  end
  local is_on = lit ~= nil and lit.value == true
  local has_lamp = row.type == 'bit' or row.contact ~= nil
  local lamp = has_lamp and (is_on and '●' or '○') or ' '
  local text = ('  %s %s'):format(lamp, row.label)
  local marks = {}
  if has_lamp then
    table.insert(marks, { 2, 2 + #lamp, is_on and 'RungwiseLampOn' or 'RungwiseLampOff' })
  end
  text = text .. (' '):rep(math.max(1, label_width(panel) - vim.fn.strdisplaywidth(text)))
  if own and row.type == 'bit' then
    text = text .. (is_on and '1' or '0')
    if own.wired ~= nil and not own.forced then
      -- The next scan will see it.
      text = text .. ' → ' .. (own.wired and '1' or '0')
    end
  elseif own then
    local preset = row.preset or row.preset_of and (panel.values[row.preset_of] or {}).value
    local base = panel.bases[row.name] or 'decimal'
    local read = panel.values[bases.read_as(row.name, base)]
    local number = base == 'decimal' and reading(row, own.value) or bases.written(read and read.value, base)
    text = text .. number .. (preset and ' / ' .. reading(row, preset) or '')
  end
  if own and own.forced or contact and contact.forced then
    local first = #text + 1
    text = text .. ' ' .. t('[forced]')
    table.insert(marks, { first, #text, 'RungwiseForced' })
  end
  local said = vim.trim(row.symbol .. '  ' .. row.comment)
  if said ~= '' then
    text = text .. (' '):rep(math.max(2, label_width(panel) + 14 - vim.fn.strdisplaywidth(text)))
    table.insert(marks, { #text, #text + #said, 'Comment' })
    text = text .. said
  end
  return text, marks
end

local function head_line(panel)
  local modes = { running = t('running'), paused = t('paused'), stopped = t('stopped') }
  local signs = { running = '▶', paused = '⏸', stopped = '■' }
  local words = { signs[panel.mode] .. ' ' .. (panel.is_plc and t('PLC') or modes[panel.mode]) }
  if panel.is_plc then
    table.insert(words, ('%.2f s'):format(panel.time_ms / 1000))
    if (panel.exchanges or 1) > 1 then
      table.insert(words, t('values of up to %d scans', panel.exchanges))
    end
  elseif panel.mode ~= 'stopped' then
    table.insert(words, t('scan %d', panel.scan))
    table.insert(words, ('%.2f s'):format(panel.time_ms / 1000))
  end
  table.insert(words, t('g? help'))
  return table.concat(words, ' · ')
end

local function width_of(panel)
  local window = vim.fn.bufwinid(panel.buffer)
  local info = window ~= -1 and vim.fn.getwininfo(window)[1]
  return math.max(20, (info and info.width - info.textoff or 60) - label_width(panel) - 1)
end

--- What the chart shows: the last scans, or where it was moved to.
local function view_of(panel)
  local width = width_of(panel)
  local shown = width * panel.scans
  local from = panel.from or math.max(0, panel.scan - shown + 1)
  return { from = from, scans = panel.scans, width = width, last = math.min(panel.scan, panel.charted_to or 0) }
end

local function chart_lines(panel, lines, marks)
  if #panel.signals == 0 then
    return
  end
  local view = view_of(panel)
  local ms = panel.scan_ms or 10
  local ends = { ('%.2f s'):format(view.from * ms / 1000), ('%.2f s'):format((view.from + view.width * view.scans) * ms / 1000) }
  vim.list_extend(lines, { '', t('Timing chart') })
  marks[#lines] = { { 0, #lines[#lines], 'RungwiseGroup' } }
  local gap = math.max(1, view.width - vim.fn.strdisplaywidth(ends[1] .. ends[2]))
  table.insert(lines, (' '):rep(label_width(panel)) .. ends[1] .. (' '):rep(gap) .. ends[2])
  marks[#lines] = { { 0, #lines[#lines], 'Comment' } }
  for _, name in ipairs(panel.signals) do
    local row = panel.by_name[name]
    local columns = chart.columns(panel.points[name] or {}, view)
    local label = '  ' .. row.label
    label = label .. (' '):rep(math.max(1, label_width(panel) - vim.fn.strdisplaywidth(label)))
    local line = row.type == 'bit' and chart.bit_line(columns) or chart.word_line(columns)
    table.insert(lines, label .. line)
    marks[#lines] = { { #label, #label + #line, row.type == 'bit' and 'RungwiseChartOn' or 'RungwiseChartWord' } }
  end
end

--- Writes the lines that have changed; the cursor stays.
local function draw(panel)
  if not vim.api.nvim_buf_is_valid(panel.buffer) then
    return
  end
  local lines, marks = { head_line(panel), '' }, {}
  panel.rows_at = {}
  local group
  for _, row in ipairs(panel.rows) do
    if row.group ~= group then
      if group then
        table.insert(lines, '')
      end
      group = row.group
      table.insert(lines, group_title(group))
      marks[#lines] = { { 0, #lines[#lines], 'RungwiseGroup' } }
    end
    local text, own = row_line(panel, row)
    table.insert(lines, text)
    marks[#lines], panel.rows_at[#lines] = own, row
  end
  if #panel.rows == 0 then
    table.insert(lines, panel.mode == 'stopped' and t('S starts the simulation.') or t('The program uses no devices.'))
  end
  chart_lines(panel, lines, marks)
  local before = panel.lines or vim.api.nvim_buf_get_lines(panel.buffer, 0, -1, false)
  vim.bo[panel.buffer].modifiable = true
  if #before > #lines then
    vim.api.nvim_buf_set_lines(panel.buffer, #lines, -1, false, {})
  end
  for at, line in ipairs(lines) do
    if line ~= before[at] then
      vim.api.nvim_buf_set_lines(panel.buffer, at - 1, at, false, { line })
      vim.api.nvim_buf_clear_namespace(panel.buffer, SPACE, at - 1, at)
      for _, mark in ipairs(marks[at] or {}) do
        vim.api.nvim_buf_set_extmark(panel.buffer, SPACE, at - 1, mark[1], { end_col = mark[2], hl_group = mark[3] })
      end
    end
  end
  vim.bo[panel.buffer].modifiable = false
  vim.bo[panel.buffer].modified = false
  panel.lines = lines
end

--- What a panel may tell a PLC, and how its server calls that; of these, what writes.
local PLC_VERBS = {
  set = 'write', force = 'hold', release = 'release', watch = 'monitor', panel = 'panel', trace = 'trace',
}
local WRITES = { set = true, force = true }

--- Tells who shows the program something: its simulation, or the PLC in which it is monitored.
local function tell(panel, verb, more, done)
  if not panel.is_plc then
    return require('rungwise.simulation').tell(panel.program, verb, more, done)
  end
  if not PLC_VERBS[verb] then
    return client.notify(t('a PLC cannot do this'), vim.log.levels.WARN)
  end
  if WRITES[verb] and not panel.is_unlocked then
    local question = t('Let this panel write into the PLC? The machine may move.')
    panel.is_unlocked = vim.fn.confirm(question, t('&Yes') .. '\n' .. t('&No'), 2) == 1
    if not panel.is_unlocked then
      return
    end
  end
  require('rungwise.plc').tell(panel.program, PLC_VERBS[verb], more or {}, done and function(answer)
    -- Where a PLC is, only pictures tell.
    done(vim.tbl_extend('keep', { scan = panel.scan, mode = panel.mode, time_ms = panel.time_ms }, answer or {}))
  end)
end

--- Asks for what the chart shows, unless an answer is still awaited.
local function ask_chart(panel)
  if panel.is_asking or panel.mode == 'stopped' or #panel.signals == 0 or vim.fn.bufwinid(panel.buffer) == -1 then
    return
  end
  panel.is_asking = true
  local view = view_of(panel)
  local wish = { names = panel.signals, from = view.from, to = view.from + view.width * view.scans, most = 4 * view.width }
  tell(panel, 'trace', wish, function(answer)
    panel.charted_to = answer.to
    for _, signal in ipairs(answer.signals or {}) do
      panel.points[signal.name] = signal.points
    end
    draw(panel)
  end)
  -- Also after an answer that is an error, a later picture asks again.
  vim.defer_fn(function()
    panel.is_asking = false
    if panel.scan ~= panel.charted_to and panel.mode == 'paused' then
      ask_chart(panel)
    end
  end, CHART_MS)
end

--- What a moment of the simulation changes.
local function take(panel, moment)
  panel.exchanges = moment.exchanges
  if moment.source == 'plc' then
    -- Its scans are milliseconds here, for nothing is known of them; a PLC that stands still is looked at all the same.
    local scan = math.floor(moment.time_ms)
    moment = vim.tbl_extend('force', moment, { mode = 'running', scan = scan, scan_ms = 1 })
  end
  panel.mode, panel.scan, panel.time_ms = moment.mode, moment.scan or 0, moment.time_ms or 0
  panel.scan_ms = moment.scan_ms or panel.scan_ms
  for _, value in ipairs(moment.values or {}) do
    panel.values[value.device] = value
  end
  for name, later in pairs(panel.later) do
    if panel.scan > later.after or panel.mode == 'stopped' then
      panel.later[name] = nil
      tell(panel, 'set', { name = name, value = later.value })
    end
  end
  draw(panel)
end

--- The rows that a window shows, whose values are wanted.
local function watch(panel)
  local names = {}
  for _, window in ipairs(vim.fn.win_findbuf(panel.buffer)) do
    for line = vim.fn.line('w0', window), vim.fn.line('w$', window) do
      local row = panel.rows_at and panel.rows_at[line]
      local read = row and bases.read_as(row.name, panel.bases[row.name])
      for _, name in ipairs(row and { row.name, read, row.contact or vim.NIL, row.preset_of or vim.NIL } or {}) do
        if name ~= vim.NIL then
          table.insert(names, name)
        end
      end
    end
  end
  if panel.mode ~= 'stopped' then
    tell(panel, 'watch', { names = names })
  end
end

local function first_signals(rows)
  local signals = {}
  for _, row in ipairs(rows) do
    if #signals < FIRST_SIGNALS and vim.list_contains({ 'inputs', 'outputs', 'timers' }, row.group) then
      table.insert(signals, row.name)
    end
  end
  return signals
end

--- Reads what belongs on the panel.
local function read(panel)
  panel.is_plc = require('rungwise.simulation').is_plc(panel.program)
  if panel.is_plc and panel.scans < PLC_SCANS then
    panel.scans = PLC_SCANS
  end
  tell(panel, 'panel', { names = panel.chosen }, function(answer)
    panel.rows, panel.by_name, panel.edition = answer.rows or {}, {}, answer.edition or panel.edition
    panel.mode = panel.is_plc and 'running' or panel.mode
    for _, row in ipairs(panel.rows) do
      panel.by_name[row.name] = row
    end
    panel.signals = vim.tbl_filter(function(name)
      return panel.by_name[name] ~= nil
    end, panel.has_chosen and panel.signals or first_signals(panel.rows))
    take(panel, answer)
    watch(panel)
    ask_chart(panel)
  end)
end

--- The simulation of a program has begun.
function M.on_start(program)
  for _, panel in pairs(panels) do
    if panel.program == program then
      panel.points = {}
      read(panel)
    end
  end
end

--- A picture of a simulation, or nil when it has ended.
function M.on_picture(program, picture)
  for _, panel in pairs(panels) do
    if panel.program == program then
      if not picture then
        panel.is_unlocked = nil
        take(panel, { mode = 'stopped' })
      else
        take(panel, picture)
        ask_chart(panel)
        if picture.edition ~= panel.edition then
          panel.edition = picture.edition
          read(panel)
        end
      end
    end
  end
end

local function is_forced(panel, row)
  local own, contact = panel.values[row.name], panel.values[row.contact or '']
  return own and own.forced or contact and contact.forced or false
end

--- The bit of a row: itself, or the contact of a timer or counter.
local function bit_of(panel, row)
  local name = row.contact or row.name
  local found = panel.values[name]
  if not found or type(found.value) ~= 'boolean' then
    return nil
  end
  if found.wired ~= nil and not found.forced then
    return name, found.wired
  end
  return name, found.value
end

--- What keys do on a row.
local ON_ROW = {
  toggle = function(panel, row)
    local name, value = bit_of(panel, row)
    if name and row.type == 'bit' then
      tell(panel, is_forced(panel, row) and 'force' or 'set', { name = name, value = not value })
    else
      client.notify(t('"%s" is no relay', row.label), vim.log.levels.WARN)
    end
  end,
  pulse = function(panel, row)
    local name, value = bit_of(panel, row)
    if name and row.type == 'bit' then
      tell(panel, 'set', { name = name, value = not value }, function(state)
        -- Let go once a scan has seen it.
        panel.later[name] = { after = state.scan, value = value }
      end)
    end
  end,
  force = function(panel, row)
    local name, value = bit_of(panel, row)
    if name then
      tell(panel, 'force', { name = name, value = is_forced(panel, row) ~= value })
    elseif panel.values[row.name] then
      tell(panel, 'force', { name = row.name, value = panel.values[row.name].value })
    end
  end,
  release = function(panel, row)
    tell(panel, 'release', { name = row.name })
    if row.contact then
      tell(panel, 'release', { name = row.contact })
    end
  end,
  more = function(panel, row)
    local own = panel.values[row.name]
    if own and type(own.value) == 'number' then
      tell(panel, 'set', { name = row.name, value = own.value + vim.v.count1 })
    end
  end,
  less = function(panel, row)
    local own = panel.values[row.name]
    if own and type(own.value) == 'number' then
      tell(panel, 'set', { name = row.name, value = own.value - vim.v.count1 })
    end
  end,
  value = function(panel, row)
    vim.ui.input({ prompt = t('Value of %s: ', row.label) }, function(word)
      if word and word ~= '' then
        local base = panel.bases[row.name]
        local value = bases.typed(word, base)
        if value == nil then
          return client.notify(t('"%s" is no number', word), vim.log.levels.WARN)
        end
        tell(panel, 'set', { name = bases.read_as(row.name, base), value = value })
      end
    end)
  end,
  --- The next way to write the number of a register.
  base = function(panel, row)
    local known = bases.of(row)
    for at, base in ipairs(known) do
      if base == (panel.bases[row.name] or 'decimal') then
        panel.bases[row.name] = known[at % #known + 1]
        break
      end
    end
    watch(panel)
    draw(panel)
  end,
  chart = function(panel, row)
    local others = vim.tbl_filter(function(name)
      return name ~= row.name
    end, panel.signals)
    if #others == #panel.signals then
      table.insert(others, row.name)
    end
    panel.signals, panel.has_chosen = others, true
    draw(panel)
    ask_chart(panel)
  end,
}

--- Moves what the chart shows by half of it; at the newest scan it follows again.
local function pan(panel, direction)
  local view = view_of(panel)
  local from = view.from + direction * math.floor(view.width * view.scans / 2)
  panel.from = from + view.width * view.scans < panel.scan and math.max(0, from) or nil
  draw(panel)
  ask_chart(panel)
end

local function zoom(panel, scans)
  panel.scans = math.min(math.max(scans, 1), 1000000)
  draw(panel)
  ask_chart(panel)
end

--- What keys do anywhere.
local ANYWHERE = {
  step = function(panel)
    tell(panel, 'step', { count = vim.v.count1 })
  end,
  back = function(panel)
    tell(panel, 'stepBack', { count = vim.v.count1 })
  end,
  pause = function(panel)
    tell(panel, panel.mode == 'running' and 'pause' or 'run')
  end,
  reset = function(panel)
    tell(panel, 'reset')
  end,
  start = function(panel)
    if panel.is_plc then
      return client.notify(t('a PLC cannot do this'), vim.log.levels.WARN)
    end
    require('rungwise.simulation').verbs[panel.mode == 'stopped' and 'start' or 'stop'](panel.program)
  end,
  --- Devices that are shown although the program does not use them.
  choose = function(panel)
    vim.ui.input({ prompt = t('Devices: '), default = table.concat(panel.chosen, ' ') }, function(words)
      if words then
        panel.chosen = vim.split(words:upper(), '[%s,;]+', { trimempty = true })
        read(panel)
      end
    end)
  end,
  release_all = function(panel)
    tell(panel, 'release')
  end,
  reload = function(panel)
    panel.lines = nil
    read(panel)
  end,
  earlier = function(panel)
    pan(panel, -1)
  end,
  later = function(panel)
    pan(panel, 1)
  end,
  newest = function(panel)
    panel.from = nil
    zoom(panel, panel.scans)
  end,
  closer = function(panel)
    zoom(panel, math.floor(panel.scans / 2))
  end,
  farther = function(panel)
    zoom(panel, panel.scans * 2)
  end,
  close = function(panel)
    vim.api.nvim_buf_delete(panel.buffer, { force = true })
  end,
  help = function()
    vim.cmd('help rungwise-panel')
  end,
}

local KEYS = {
  ['<CR>'] = 'toggle', ['<Space>'] = 'toggle', p = 'pulse', f = 'force', r = 'release', ['+'] = 'more', ['-'] = 'less',
  ['='] = 'value', c = 'chart', s = 'step', b = 'back', P = 'pause', R = 'reset', S = 'start', ['gr'] = 'release_all',
  ['<C-l>'] = 'reload', ['<'] = 'earlier', ['>'] = 'later', ze = 'newest', zi = 'closer', zo = 'farther', q = 'close',
  ['g?'] = 'help', v = 'base', a = 'choose',
}

local function map_keys(panel)
  for key, name in pairs(KEYS) do
    vim.keymap.set('n', key, function()
      if ANYWHERE[name] then
        ANYWHERE[name](panel)
      else
        local row = panel.rows_at[vim.fn.line('.')]
        if row and panel.mode ~= 'stopped' then
          ON_ROW[name](panel, row)
        end
      end
    end, { buffer = panel.buffer, nowait = true })
  end
end

--- Shows the panel of the program in a buffer, in a window beside.
function M.open(program)
  for _, panel in pairs(panels) do
    if panel.program == program and vim.api.nvim_buf_is_valid(panel.buffer) then
      local window = vim.fn.bufwinid(panel.buffer)
      if window ~= -1 then
        vim.api.nvim_set_current_win(window)
      else
        vim.cmd('botright vsplit')
        vim.api.nvim_win_set_buf(0, panel.buffer)
      end
      return
    end
  end
  local buffer = vim.api.nvim_create_buf(false, true)
  vim.api.nvim_buf_set_name(buffer, 'rungwise://panel/' .. vim.fn.fnamemodify(vim.api.nvim_buf_get_name(program), ':t'))
  vim.bo[buffer].filetype = 'rungwise-panel'
  vim.bo[buffer].bufhidden = 'hide'
  vim.bo[buffer].modifiable = false
  local panel = {
    buffer = buffer, program = program, mode = 'stopped', scan = 0, time_ms = 0, rows = {}, by_name = {}, rows_at = {},
    values = {}, points = {}, later = {}, signals = {}, scans = 4, bases = {}, chosen = {},
  }
  panels[buffer] = panel
  map_keys(panel)
  vim.cmd('botright vsplit')
  vim.api.nvim_win_set_buf(0, buffer)
  local options = { wrap = false, number = false, relativenumber = false, signcolumn = 'no', list = false, cursorline = true }
  for name, value in pairs(options) do
    vim.wo[name] = value
  end
  local group = vim.api.nvim_create_augroup('rungwise_panel_' .. buffer, { clear = true })
  local timer
  vim.api.nvim_create_autocmd({ 'WinScrolled', 'BufWinEnter', 'WinResized' }, {
    group = group,
    callback = function()
      if not timer then
        timer = vim.defer_fn(function()
          timer = nil
          if panels[buffer] and #vim.fn.win_findbuf(buffer) > 0 then
            watch(panel)
            draw(panel)
          end
        end, SCROLL_MS)
      end
    end,
  })
  vim.api.nvim_create_autocmd('BufWipeout', {
    buffer = buffer,
    callback = function()
      panels[buffer] = nil
      vim.api.nvim_del_augroup_by_id(group)
      if panel.mode ~= 'stopped' and vim.api.nvim_buf_is_valid(program) then
        tell(panel, 'watch', { names = {} })
      end
    end,
  })
  draw(panel)
  if require('rungwise.simulation').running[vim.uri_from_bufnr(program)] then
    read(panel)
  else
    ANYWHERE.start(panel)
  end
end

return M
