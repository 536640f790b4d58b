-- The I/O panel of a simulation in a real Neovim. Run by neovim/run.sh in a copy of the fixtures.

local report = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/report.lua')
local check, finish = report.check, report.finish
local TIMEOUT_MS = 15000
local program, panel

local function panel_lines()
  return panel and vim.api.nvim_buf_get_lines(panel, 0, -1, false) or {}
end

local function until_true(what, probe)
  if not vim.wait(TIMEOUT_MS, probe, 20) then
    error(('waited %d ms for %s; the panel:\n%s'):format(TIMEOUT_MS, what, table.concat(panel_lines(), '\n')), 0)
  end
end

--- The first line of the panel with this beginning, blanks and lamp aside, and its number.
local function line_of(name)
  for at, line in ipairs(panel_lines()) do
    -- Patterns are of bytes: a lamp is three of them.
    if line:match('^%s+[^%w%s]*%s*' .. name .. '%f[%s]') then
      return line, at
    end
  end
  return '', 0
end

--- The line of a signal in the chart.
local function chart_of(name)
  local lines = panel_lines()
  for at = #lines, 1, -1 do
    if lines[at]:match('^  ' .. name .. '%f[%s]') then
      return lines[at]
    end
  end
  return ''
end

--- Puts the cursor on the line of a device and presses keys there.
local function press(name, keys)
  local _, at = line_of(name)
  assert(at > 0, name .. ' has no line')
  vim.api.nvim_win_set_cursor(vim.fn.bufwinid(panel), { at, 2 })
  vim.api.nvim_feedkeys(vim.api.nvim_replace_termcodes(keys, true, false, true), 'mtx', false)
end

local function lamp(name)
  local line = line_of(name)
  return line:find('●', 1, true) and '●' or line:find('○', 1, true) and '○' or nil
end

--- The highlights of the line of a device.
local function highlights(name)
  local _, at = line_of(name)
  local space = vim.api.nvim_get_namespaces().rungwise_panel
  local marks = vim.api.nvim_buf_get_extmarks(panel, space, { at - 1, 0 }, { at - 1, -1 }, { details = true })
  return vim.tbl_map(function(mark)
    return mark[4].hl_group
  end, marks)
end

check('the panel starts the simulation and has what the program uses', function()
  vim.cmd('silent edit motor.lad')
  program = vim.api.nvim_get_current_buf()
  until_true('the client', function()
    return #vim.lsp.get_clients({ bufnr = program, name = 'rungwise' }) == 1
  end)
  vim.cmd('Rungwise simulate panel')
  panel = vim.api.nvim_get_current_buf()
  assert(panel ~= program and vim.bo[panel].filetype == 'rungwise-panel')
  until_true('the lamps', function()
    return lamp('X0') == '○' and lamp('Y0') == '○' and lamp('T0') == '○' and line_of('T0'):find('0.0 s / 1.0 s', 1, true)
  end)
  local lines = panel_lines()
  assert(vim.list_contains(lines, 'Inputs') and vim.list_contains(lines, 'Outputs') and vim.list_contains(lines, 'Timers'))
  assert(lines[1]:find('▶ running · scan %d'), lines[1])
  assert(vim.deep_equal(highlights('X0'), { 'RungwiseLampOff' }), vim.inspect(highlights('X0')))
  assert(not vim.bo[panel].modifiable and not vim.bo[panel].modified)
end)

check('a push button starts the motor, which holds itself, and the cursor stays', function()
  press('X0', 'p')
  until_true('the motor on, the button let go', function()
    return lamp('Y0') == '●' and lamp('X0') == '○'
  end)
  assert(vim.deep_equal(highlights('Y0'), { 'RungwiseLampOn' }), vim.inspect(highlights('Y0')))
  local space = vim.api.nvim_get_namespaces().rungwise_simulation
  until_true('power in the program', function()
    local marks = vim.api.nvim_buf_get_extmarks(program, space, { 2, 0 }, { 2, -1 }, { details = true })
    return vim.iter(marks):any(function(mark)
      return mark[4].hl_group == 'RungwiseEnergised'
    end)
  end)
  until_true('the timer', function()
    return lamp('T0') == '●' and line_of('T0'):find('1.0 s / 1.0 s', 1, true) and lamp('Y1') == '●'
  end)
  local _, at = line_of('X0')
  assert(vim.deep_equal(vim.api.nvim_win_get_cursor(0), { at, 2 }), vim.inspect(vim.api.nvim_win_get_cursor(0)))
end)

check('the chart shows the press and what came of it', function()
  -- More time, so that the press is still there.
  press('X0', 'zozozozo')
  until_true('the changes', function()
    return chart_of('Y0'):find('▌▆') and chart_of('X0'):find('▌▁') and chart_of('T0'):find('███')
  end)
  press('Y1', 'c')
  until_true('a signal left out', function()
    return not chart_of('Y1'):find('▆')
  end)
  press('Y1', 'c')
  until_true('the signal again', function()
    return chart_of('Y1'):find('▆')
  end)
end)

check('keys pause, step, go back past the press, force and release', function()
  press('X0', 'P')
  until_true('a pause', function()
    return panel_lines()[1]:find('paused')
  end)
  vim.api.nvim_win_call(vim.fn.bufwinid(program), function()
    vim.cmd('Rungwise simulate back Y0')
  end)
  until_true('the motor off', function()
    return lamp('Y0') == '○'
  end)
  until_true('a chart without what was taken back', function()
    return chart_of('Y0') ~= '' and not chart_of('Y0'):find('▆')
  end)
  -- An input that is switched is seen by the next scan.
  press('X0', '<Space>')
  until_true('the switch', function()
    return line_of('X0'):find('0 → 1', 1, true) and lamp('X0') == '○'
  end)
  press('X0', 's')
  until_true('the scan', function()
    return lamp('X0') == '●' and lamp('Y0') == '●'
  end)
  press('X1', 'f')
  until_true('an input that is held', function()
    return line_of('X1'):find('[forced]', 1, true) and lamp('X1') == '○'
  end)
  press('X1', 'f')
  until_true('the same at the other value', function()
    return line_of('X1'):find('[forced]', 1, true) and lamp('X1') == '●'
  end)
  assert(vim.list_contains(highlights('X1'), 'RungwiseForced'), vim.inspect(highlights('X1')))
  press('X1', '2s')
  until_true('the motor stopped', function()
    return lamp('Y0') == '○'
  end)
  press('X1', 'r')
  until_true('released', function()
    return not line_of('X1'):find('[forced]', 1, true)
  end)
end)

check('words are changed by keys, and an edit brings its devices', function()
  vim.api.nvim_buf_call(program, function()
    vim.cmd('silent %delete _ | call setline(1, ["|  X7                        |", "+--| |-----[MOV D3 D4]----+"])')
  end)
  vim.api.nvim_buf_set_lines(program, 0, -1, false, {
    '|   X7                                         |',
    '+---| |----------------------------[MOV D3 D4]-+',
  })
  until_true('the registers', function()
    return select(2, line_of('D3')) > 0 and select(2, line_of('Y0')) == 0
  end)
  until_true('its value', function()
    return line_of('D3'):find('D3%s+0$')
  end)
  press('D3', '12+')
  until_true('the number', function()
    return line_of('D3'):find('D3%s+12$')
  end)
  press('D3', '-')
  until_true('one less', function()
    return line_of('D3'):find('D3%s+11$')
  end)
  press('X7', '<CR>')
  press('X7', 's')
  until_true('it is moved', function()
    return line_of('D4'):find('D4%s+11$')
  end)
end)

check('a simulation that is stopped is told, and starts again', function()
  press('X7', 'S')
  until_true('the end', function()
    return panel_lines()[1]:find('■ stopped', 1, true)
  end)
  vim.api.nvim_feedkeys('S', 'mtx', false)
  until_true('the start', function()
    return panel_lines()[1]:find('▶ running · scan', 1, true)
  end)
  vim.api.nvim_feedkeys('g?', 'mtx', false)
  assert(vim.bo.filetype == 'help' and vim.fn.getline('.'):find('rungwise%-panel'), vim.fn.getline('.'))
  vim.cmd('helpclose')
  vim.api.nvim_set_current_win(vim.fn.bufwinid(panel))
  vim.api.nvim_feedkeys('q', 'mtx', false)
  assert(not vim.api.nvim_buf_is_valid(panel))
end)

check('a program of IEC 61131-3 has its variables on the panel, which are switched, counted and forced', function()
  vim.cmd('silent edit counter_iec.il')
  program = vim.api.nvim_get_current_buf()
  until_true('the client', function()
    return #vim.lsp.get_clients({ bufnr = program, name = 'rungwise' }) == 1
  end)
  vim.cmd('Rungwise simulate panel')
  panel = vim.api.nvim_get_current_buf()
  assert(panel ~= program and vim.bo[panel].filetype == 'rungwise-panel')
  until_true('the variables', function()
    return lamp('Main.Start') == '○' and lamp('Main.Motor') == '○' and line_of('Main.Parts'):find('Main.Parts%s+0$')
  end)
  -- Values and waveforms stand in one column, however long the names are.
  until_true('the chart', function()
    return chart_of('Main.Start') ~= '' and chart_of('Main.Stop') ~= ''
  end)
  local function column(line, mark)
    return vim.fn.strdisplaywidth(line:sub(1, line:find(mark, 1, true) - 1))
  end
  assert(column(chart_of('Main.Start'), '▁') == column(chart_of('Main.Stop'), '▁'), table.concat(panel_lines(), '\n'))
  press('Main.Start', 'p')
  until_true('the motor on, the button let go', function()
    return lamp('Main.Motor') == '●' and lamp('Main.Start') == '○'
  end)
  until_true('a part counted', function()
    return line_of('Main.Parts'):find('Main.Parts%s+1$')
  end)
  until_true('the delay over', function()
    return lamp('Main.Ready') == '●'
  end)
  press('Main.Start', 'P')
  until_true('a pause', function()
    return panel_lines()[1]:find('paused')
  end)
  press('Main.Parts', '5+')
  until_true('the number', function()
    return line_of('Main.Parts'):find('Main.Parts%s+6$')
  end)
  press('Main.Motor', 'f')
  press('Main.Motor', 's')
  until_true('an output that is held', function()
    return line_of('Main.Motor'):find('[forced]', 1, true)
  end)
  press('Main.Motor', 'S')
  until_true('the end', function()
    return panel_lines()[1]:find('■ stopped', 1, true)
  end)
end)

finish()
