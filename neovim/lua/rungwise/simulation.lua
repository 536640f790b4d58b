--- Running the program of a buffer on the simulated PLC: power as extmarks, values behind the lines.
local client = require('rungwise.client')
local panel = require('rungwise.panel')
local t = require('rungwise.words').t
local verbs = require('rungwise.verbs')
local M = {}

local SPACE = vim.api.nvim_create_namespace('rungwise_simulation')
--- The window is told when it stands still.
local SCROLL_MS = 50

--- What runs, by the URI of each file of it: { buffer, mode, scan, files }; `files` are the URIs of all files of its
--- program, `watch` tells the ranges that are shown where it runs in a PLC.
M.running = {}
local timer

vim.api.nvim_set_hl(0, 'RungwiseEnergised', { default = true, link = 'DiffAdd' })
vim.api.nvim_set_hl(0, 'RungwiseReady', { default = true, underdotted = true })
vim.api.nvim_set_hl(0, 'RungwiseValue', { default = true, link = 'Comment' })
vim.api.nvim_set_hl(0, 'RungwiseForcedName', { default = true, bold = true, underdouble = true })
vim.api.nvim_set_hl(0, 'RungwiseForcedSign', { default = true, link = 'WarningMsg' })

--- Tells the server something about the program of a buffer; `done` gets the answer.
M.tell = verbs.teller('rungwise.simulate.')

--- The lines that windows show of a buffer.
local function ranges_of(buffer)
  local ranges = {}
  for _, window in ipairs(vim.fn.win_findbuf(buffer)) do
    local first, last = vim.fn.line('w0', window), vim.fn.line('w$', window)
    table.insert(ranges, {
      start = { line = first - 1, character = 0 }, ['end'] = { line = last, character = 0 },
    })
  end
  return ranges
end

local function watch(buffer)
  local running = M.running[vim.uri_from_bufnr(buffer)]
  if running and running.watch then
    running.watch(ranges_of(buffer))
  else
    M.tell(buffer, 'watch', { ranges = ranges_of(buffer) })
  end
end

local function scrolled()
  if not timer and next(M.running) then
    timer = vim.defer_fn(function()
      timer = nil
      for _, running in pairs(M.running) do
        if #vim.fn.win_findbuf(running.buffer) > 0 then
          watch(running.buffer)
        end
      end
    end, SCROLL_MS)
  end
end

--- Marks the cells of a range, which stands in one line.
local function mark(buffer, range, encoding, options)
  local line = range.start.line
  local text = vim.api.nvim_buf_get_lines(buffer, line, line + 1, false)[1]
  if text and range['end'].line == line then
    options.end_col = client.byte(text, range['end'].character, encoding)
    vim.api.nvim_buf_set_extmark(buffer, SPACE, line, client.byte(text, range.start.character, encoding), options)
  end
end

local function forget(buffer)
  M.running[vim.uri_from_bufnr(buffer)] = nil
  panel.on_picture(buffer, nil)
  if vim.api.nvim_buf_is_valid(buffer) then
    vim.api.nvim_buf_clear_namespace(buffer, SPACE, 0, -1)
  end
end

--- Shows nothing more of any file of the program of a buffer.
local function forget_all_of(buffer)
  local running = M.running[vim.uri_from_bufnr(buffer)] or {}
  for _, uri in ipairs(running.files or {}) do
    local other = M.running[uri]
    if other and not other.watch then
      forget(other.buffer)
    end
  end
  forget(buffer)
end

--- The text of a range within a line.
local function name_in(buffer, range, server)
  local text = vim.api.nvim_buf_get_lines(buffer, range.start.line, range.start.line + 1, false)[1] or ''
  local first = client.byte(text, range.start.character, server.offset_encoding)
  return text:sub(first + 1, client.byte(text, range['end'].character, server.offset_encoding))
end

--- The notification `rungwise/monitor`.
function M.on_monitor(_, picture, context)
  local running = type(picture) == 'table' and M.running[picture.uri]
  local server = vim.lsp.get_client_by_id(context.client_id)
  if not running or not server or not vim.api.nvim_buf_is_loaded(running.buffer) then
    return
  end
  local is_plc = picture.source == 'plc'
  if is_plc ~= (running.watch ~= nil) then
    return
  end
  if picture.mode == 'stopped' and not is_plc then
    return forget_all_of(running.buffer)
  end
  running.mode, running.scan, running.time_ms = picture.mode, picture.scan, picture.time_ms
  panel.on_picture(running.buffer, picture)
  -- What was painted of another version stands in other places.
  if picture.version ~= vim.lsp.util.buf_versions[running.buffer] then
    return
  end
  vim.api.nvim_buf_clear_namespace(running.buffer, SPACE, 0, -1)
  local values, forced = {}, {}
  local function tell(line, words)
    values[line] = values[line] or {}
    table.insert(values[line], words)
  end
  for _, element in ipairs(picture.elements or {}) do
    local line = element.range.start.line
    if element.kind == 'value' then
      tell(line, ('%s = %s'):format(name_in(running.buffer, element.range, server), tostring(element.value)))
    elseif element.kind == 'forced' then
      local value = element.value == true and 1 or element.value == false and 0 or element.value
      tell(line, t('%s forced to %s', name_in(running.buffer, element.range, server), tostring(value)))
      mark(running.buffer, element.range, server.offset_encoding, { hl_group = 'RungwiseForcedName', priority = 160 })
      forced[line] = true
    elseif element.energised or element.conducts then
      mark(running.buffer, element.range, server.offset_encoding, {
        hl_group = element.energised and 'RungwiseEnergised' or 'RungwiseReady', priority = 150,
      })
    end
  end
  for line in pairs(forced) do
    vim.api.nvim_buf_set_extmark(running.buffer, SPACE, line, 0, {
      sign_text = 'F', sign_hl_group = 'RungwiseForcedSign', priority = 160,
    })
  end
  for line, words in pairs(values) do
    vim.api.nvim_buf_set_extmark(running.buffer, SPACE, line, 0, {
      virt_text = { { table.concat(words, ', '), 'RungwiseValue' } }, virt_text_pos = 'eol',
    })
  end
  for _, failed in ipairs(picture.errors or {}) do
    vim.api.nvim_buf_set_extmark(running.buffer, SPACE, failed.range.start.line, 0, {
      virt_text = { { failed.message, 'DiagnosticVirtualTextError' } }, virt_text_pos = 'eol',
    })
  end
  vim.cmd.redrawstatus()
end

local function add(buffer, state)
  M.running[vim.uri_from_bufnr(buffer)] = { buffer = buffer, mode = state.mode, files = state.files }
  watch(buffer)
end

--- Shows what is simulated also in a buffer with another file of the program.
local function join(buffer)
  local uri = vim.uri_from_bufnr(buffer)
  local is_simulating = vim.iter(pairs(M.running)):any(function(_, running)
    return not running.watch
  end)
  if not is_simulating or M.running[uri] or #client.clients(buffer) == 0 then
    return
  end
  M.tell(buffer, 'state', {}, function(state)
    if state.mode ~= 'stopped' and not M.running[uri] and vim.api.nvim_buf_is_loaded(buffer) then
      add(buffer, state)
    end
  end)
end

--- Tells what windows show from now on, until the buffer goes.
local function follow()
  local group = vim.api.nvim_create_augroup('rungwise_simulation', { clear = true })
  local events = { 'WinScrolled', 'BufWinEnter', 'TextChanged', 'TextChangedI' }
  vim.api.nvim_create_autocmd(events, { group = group, callback = scrolled })
  vim.api.nvim_create_autocmd({ 'BufWinEnter', 'LspAttach' }, {
    group = group,
    callback = function(event)
      join(event.buf)
    end,
  })
  vim.api.nvim_create_autocmd('BufUnload', {
    group = group,
    callback = function(event)
      if M.running[vim.uri_from_bufnr(event.buf)] then
        forget(event.buf)
      end
    end,
  })
end

local function start(buffer)
  M.tell(buffer, 'start', {}, function(state)
    follow()
    add(buffer, state)
    panel.on_start(buffer)
    for _, window in ipairs(vim.api.nvim_list_wins()) do
      join(vim.api.nvim_win_get_buf(window))
    end
  end)
end

--- Shows what the program of a buffer does in the PLC that is connected; `tell` is told the ranges that are shown.
function M.follow_plc(buffer, tell)
  M.unfollow_plc()
  M.running[vim.uri_from_bufnr(buffer)] = { buffer = buffer, mode = 'running', watch = tell }
  follow()
  watch(buffer)
  panel.on_start(buffer)
end

--- Whether what the program of a buffer does in a PLC is shown.
function M.is_plc(buffer)
  local running = M.running[vim.uri_from_bufnr(buffer)]
  return running ~= nil and running.watch ~= nil
end

--- Shows no more of any PLC.
function M.unfollow_plc()
  for _, running in pairs(vim.deepcopy(M.running)) do
    if running.watch then
      forget(running.buffer)
    end
  end
end

--- The word under the cursor, or the one that is named.
local function name_of(words)
  return words[1] or vim.fn.expand('<cword>')
end

--- What `:Rungwise simulate VERB …` does.
M.verbs = {
  panel = function(buffer)
    panel.open(buffer)
  end,
  start = start,
  stop = function(buffer)
    forget_all_of(buffer)
    M.tell(buffer, 'stop')
  end,
  pause = function(buffer)
    M.tell(buffer, 'pause')
  end,
  run = function(buffer)
    M.tell(buffer, 'run')
  end,
  step = function(buffer, words)
    M.tell(buffer, 'step', { count = tonumber(words[1]) })
  end,
  back = function(buffer, words)
    local count = tonumber(words[1])
    M.tell(buffer, 'stepBack', { count = count, changeOf = not count and words[1] or nil })
  end,
  reset = function(buffer)
    M.tell(buffer, 'reset')
  end,
  toggle = function(buffer, words)
    local name = name_of(words)
    M.tell(buffer, 'state', { names = { name } }, function(state)
      local found = state.values and state.values[1] or {}
      local value = found.value
      if found.wired ~= nil then
        value = found.wired
      end
      if type(value) == 'boolean' then
        M.tell(buffer, 'set', { name = name, value = not value })
      else
        client.notify(t('"%s" is no relay', name), vim.log.levels.WARN)
      end
    end)
  end,
  set = function(buffer, words)
    M.tell(buffer, 'set', { name = words[1], value = words[2] })
  end,
  force = function(buffer, words)
    M.tell(buffer, 'force', { name = words[1], value = words[2] })
  end,
  --- What was done so far as a scenario test, in a new buffer.
  record = function(buffer)
    M.tell(buffer, 'record', {}, function(recorded)
      local folder = vim.fs.dirname(vim.api.nvim_buf_get_name(buffer))
      local stem, name, number = recorded.name:gsub('%.test%.toml$', ''), recorded.name, 1
      while vim.uv.fs_stat(vim.fs.joinpath(folder, name)) or vim.fn.bufexists(vim.fs.joinpath(folder, name)) == 1 do
        number = number + 1
        name = ('%s-%d.test.toml'):format(stem, number)
      end
      vim.cmd.split(vim.fn.fnameescape(vim.fs.joinpath(folder, name)))
      vim.api.nvim_buf_set_lines(0, 0, -1, false, vim.split(vim.trim(recorded.text), '\n'))
    end)
  end,
  release = function(buffer, words)
    M.tell(buffer, 'release', { name = words[1] })
  end,
  why = function(buffer, words)
    local server = client.expect(buffer)
    if server then
      local encoding = server.offset_encoding
      local here = vim.lsp.util.make_position_params(0, encoding).position
      M.tell(buffer, 'why', words[1] and { name = words[1] } or { position = here }, function(reason)
        require('rungwise.why').show(reason, encoding)
      end)
    end
  end,
}

--- The verbs, sorted.
function M.names()
  return verbs.names(M.verbs)
end

--- Runs `:Rungwise simulate VERB WORD…`; without a verb it starts.
function M.run(words)
  verbs.run('simulate', M.verbs, 'start', words)
end

return M
