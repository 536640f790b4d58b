--- A PLC on a line: `:Rungwise plc VERB …`. Nothing is said to a PLC but what these ask for.
local client = require('rungwise.client')
local drift = require('rungwise.drift')
local simulation = require('rungwise.simulation')
local t = require('rungwise.words').t
local verbs = require('rungwise.verbs')
local M = {}

--- What the server told of the PLC last.
M.state = { connected = false }

--- The alarms of PLC and simulator, the newest last: what `rungwise/alarm` tells, and `gone_ms` once they are.
M.alarms = {}
local MOST_ALARMS = 50

--- Has something done about the program of a buffer; `done` gets the answer.
local tell = verbs.teller('rungwise.plc.')

M.tell = tell

--- Ends what takes long, while something does.
local cancel

--- Has something done that takes long: until it is over, `:Rungwise plc cancel` and <C-c> in the buffer end it.
local function tell_long(buffer, verb, more, done)
  if cancel then
    client.notify(t('something else goes on with the PLC; :Rungwise plc cancel ends it'), vim.log.levels.ERROR)
    return
  end
  local before = vim.api.nvim_buf_call(buffer, function()
    return vim.fn.maparg('<C-c>', 'n', false, true)
  end)
  cancel = tell(buffer, verb, more, done, function()
    cancel = nil
    if not vim.api.nvim_buf_is_valid(buffer) then
      return
    end
    vim.keymap.del('n', '<C-c>', { buffer = buffer })
    if before.buffer == 1 then
      vim.api.nvim_buf_call(buffer, function()
        vim.fn.mapset('n', false, before)
      end)
    end
  end)
  if cancel then
    vim.keymap.set('n', '<C-c>', M.verbs.cancel, { buffer = buffer, desc = t('End what goes on with the PLC') })
  end
end

--- What the PLC is and does, in a line.
local function line_of(state)
  if not state.connected then
    return t('no PLC is connected')
  end
  local words = { ('%s %s %s'):format(state.title, state.version, state.mode), state.port }
  for _, failed in ipairs(state.errors or {}) do
    table.insert(words, ('%s = %d'):format(failed.register, failed.code))
  end
  if state.match == 'same' then
    table.insert(words, t('the program in the PLC is the same'))
  elseif state.match == 'different' then
    table.insert(words, t('the program in the PLC is another one'))
  end
  return table.concat(words, ', ')
end

--- The notification `rungwise/plc`.
function M.on_state(_, state)
  if type(state) ~= 'table' then
    return
  end
  local before = M.state
  M.state = state
  if before.connected and state.reason then
    client.notify(state.reason, vim.log.levels.ERROR)
  end
  if before.monitoring and not state.monitoring then
    simulation.unfollow_plc()
  end
  drift.on_state(state)
  vim.cmd.redrawstatus()
end

--- The notification `rungwise/alarm`. The server tells the person by itself when an alarm is raised; here it is kept for
--- the list, and that it is gone is told.
function M.on_alarm(_, told)
  if type(told) ~= 'table' then
    return
  end
  local known = vim.iter(M.alarms):rfind(function(alarm)
    return alarm.uri == told.uri and alarm.source == told.source and alarm.when == told.when and not alarm.gone_ms
  end)
  if told.raised then
    table.insert(M.alarms, told)
    if #M.alarms > MOST_ALARMS then
      table.remove(M.alarms, 1)
    end
  elseif known then
    known.gone_ms = told.at_ms
    client.notify(t('alarm gone: %s', told.message))
  end
  vim.cmd.redrawstatus()
end

--- An alarm in a line, with the times when it was raised and gone.
local function line_of_alarm(alarm)
  local function clock(ms)
    return os.date('%H:%M:%S', math.floor(ms / 1000))
  end
  local span = alarm.gone_ms and clock(alarm.at_ms) .. ' – ' .. clock(alarm.gone_ms)
    or t('since %s', clock(alarm.at_ms))
  local where = alarm.source == 'simulator' and ' · ' .. t('simulation') or ''
  return ('%s  %s%s  (%s)'):format(span, alarm.message, where, alarm.when)
end

--- Shows what is in the PLC beside what shall be there, in a tab of their own.
local function show_difference(plan)
  vim.cmd.tabnew()
  for number, side in ipairs({ 'before', 'after' }) do
    if number == 2 then
      vim.cmd('rightbelow vsplit')
    end
    local buffer = vim.api.nvim_create_buf(false, true)
    vim.api.nvim_win_set_buf(0, buffer)
    vim.api.nvim_buf_set_lines(buffer, 0, -1, false, vim.split(vim.trim(plan[side]), '\n'))
    vim.bo[buffer].modifiable = false
    vim.bo[buffer].bufhidden = 'wipe'
    vim.api.nvim_buf_set_name(buffer, ('rungwise://plc/%d/%s.%s'):format(buffer, side, plan.form == 'ladder' and 'lad' or 'il'))
    vim.cmd.diffthis()
  end
  vim.cmd.redraw()
end

local function is_confirmed(question)
  return vim.fn.confirm(question, t('&Yes') .. '\n' .. t('&No'), 2) == 1
end

--- What `:Rungwise plc VERB …` does.
M.verbs = {
  connect = function(buffer, words)
    tell(buffer, 'connect', { port = words[1] }, function(state)
      client.notify(line_of(state))
    end)
  end,
  disconnect = function(buffer)
    tell(buffer, 'disconnect')
  end,
  ports = function(buffer)
    tell(buffer, 'ports', {}, function(found)
      local lines = vim.tbl_map(function(port)
        return vim.trim(port.name .. '  ' .. port.description)
      end, found.ports)
      client.notify(#lines > 0 and table.concat(lines, '\n') or t('this computer has no serial port'))
    end)
  end,
  --- Ends what takes long. The server tells what has become of the PLC.
  cancel = function()
    if cancel then
      cancel()
    else
      client.notify(t('nothing goes on with the PLC'))
    end
  end,
  --- The alarms, the newest first.
  alarms = function()
    local lines = vim.iter(M.alarms):rev():map(line_of_alarm):totable()
    client.notify(#lines > 0 and table.concat(lines, '\n') or t('there was no alarm'))
  end,
  status = function(buffer)
    tell(buffer, 'state', {}, function(state)
      client.notify(line_of(state))
    end)
  end,
  --- Whether the program in the PLC is that of the buffer.
  verify = function(buffer)
    tell_long(buffer, 'verify', {}, function(plan)
      if plan.same then
        client.notify(t('the program in the PLC is the same'))
      else
        show_difference(plan)
      end
    end)
  end,
  --- Shows what changes, asks, and writes; `start` as its word starts the PLC afterwards.
  download = function(buffer, words)
    local is_start = words[1] == 'start'
    tell_long(buffer, 'plan', {}, function(plan)
      if not plan.same then
        show_difference(plan)
      end
      local question = t('Stop the PLC and write %d bytes into it?', plan.bytes)
      if is_start then
        question = t('Stop the PLC, write %d bytes into it and start it? The machine may move.', plan.bytes)
      end
      if is_confirmed(table.concat(vim.list_extend({ question }, plan.parameters or {}), '\n')) then
        tell_long(buffer, 'download', { confirmed = true, start = is_start, sum = plan.sum }, function(done)
          client.notify(t('%d bytes written, %d read back and compared; the PLC is in %s',
            done.written, done.compared, done.mode))
        end)
      end
    end)
  end,
  --- The program of the PLC in a new buffer.
  upload = function(buffer)
    tell_long(buffer, 'upload', {}, function(found)
      vim.cmd.new()
      vim.bo.filetype = 'plc-il'
      vim.api.nvim_buf_set_lines(0, 0, -1, false, vim.split(vim.trim(found.text), '\n'))
    end)
  end,
  start = function(buffer)
    if is_confirmed(t('Start the PLC? The machine may move.')) then
      tell(buffer, 'start', { confirmed = true })
    end
  end,
  stop = function(buffer)
    tell(buffer, 'stop')
  end,
  --- Shows the power of the PLC in the text, or no longer.
  monitor = function(buffer)
    if M.state.monitoring == vim.uri_from_bufnr(buffer) then
      simulation.unfollow_plc()
      tell(buffer, 'unmonitor')
    else
      simulation.follow_plc(buffer, function(ranges)
        tell(buffer, 'monitor', { ranges = ranges })
      end)
    end
  end,
  write = function(buffer, words)
    tell(buffer, 'write', { name = words[1], value = words[2] })
  end,
  force = function(buffer, words)
    tell(buffer, 'force', { name = words[1], value = words[2] })
  end,
  hold = function(buffer, words)
    tell(buffer, 'hold', { name = words[1], value = words[2] })
  end,
  --- Lets one go, or all.
  release = function(buffer, words)
    tell(buffer, 'release', { name = words[1] })
  end,
  --- The table of the program's devices with what they are in the PLC, which is monitored for it.
  table = function(buffer)
    if M.state.monitoring ~= vim.uri_from_bufnr(buffer) then
      M.verbs.monitor(buffer)
    end
    require('rungwise.panel').open(buffer)
  end,
  --- What was seen while a program was monitored, in a file that ends in .csv or .vcd.
  record = function(buffer, words)
    local path = words[1] and vim.fs.normalize(words[1])
    local format = path and path:match('%.(%a+)$')
    if format ~= 'csv' and format ~= 'vcd' then
      client.notify(t('name a file that ends in .csv or .vcd'), vim.log.levels.ERROR)
      return
    end
    tell(buffer, 'export', { format = format, names = vim.list_slice(words, 2) }, function(found)
      vim.fn.writefile(vim.split(found.text, '\n'), path)
      client.notify(path)
    end)
  end,
}

--- The verbs, sorted.
function M.names()
  return verbs.names(M.verbs)
end

--- Runs `:Rungwise plc VERB WORD…`; without a verb it tells the state.
function M.run(words)
  verbs.run('plc', M.verbs, 'status', words)
end

return M
