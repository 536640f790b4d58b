-- Editing a drawing in a Neovim with a user interface: every structural edit by its key, and text objects.

local report = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/report.lua')
local check, finish = report.check, report.finish
local nvim = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/ui.lua').start()

local SEAL_IN = {
  '|   X0        X1                           Y0  |',
  '+---| |---+---|/|--------------------------( )-+',
  '|   Y0    |                                    |',
  '+---| |---+                                    |',
}
local PLAIN = { '|   X0                                     Y0  |', '+---| |------------------------------------( )-+' }
local EMPTY = { '|                                              |', '+----------------------------------------------+' }
local TWO = { '|   X0      X1                             Y0  |', '+---| |-----| |----------------------------( )-+' }
local END = { '', '+--[END]---------------------------------------+' }

local function join(...)
  return vim.iter({ ... }):flatten():totable()
end

local function program(lines)
  return table.concat(join(lines, END), '\n')
end

local function same(what, wanted)
  nvim:until_true(what, function()
    return nvim:text() == wanted
  end)
end

--- Each: keys, the drawing before, the cursor (line and column from 0), the drawing afterwards.
local EDITS = {
  { 'insert-contact', '\\cX5<Esc>', SEAL_IN, 1, 14, {
    '|   X0        X5      X1                   Y0  |',
    '+---| |---+---| |-----|/|------------------( )-+',
    SEAL_IN[3], SEAL_IN[4],
  } },
  { 'insert-negated-contact', '\\nX5<Esc>', PLAIN, 1, 5, {
    '|   X5      X0                             Y0  |',
    '+---|/|-----| |----------------------------( )-+',
  } },
  { 'insert-coil', '\\oY1<Esc>', EMPTY, 1, 4, {
    '|                                          Y1  |',
    '+------------------------------------------( )-+',
  } },
  { 'insert-set-coil', '\\sM0<Esc>', EMPTY, 1, 4, {
    '|                                          M0  |',
    '+------------------------------------------(S)-+',
  } },
  { 'insert-reset-coil', '\\rM0<Esc>', EMPTY, 1, 4, {
    '|                                          M0  |',
    '+------------------------------------------(R)-+',
  } },
  { 'insert-box', ':Rungwise edit insert-box RET<CR>', EMPTY, 1, 4, { EMPTY[1], '+--[RET]---------------------------------------+' } },
  { 'insert-branch', '\\bX2<Esc>', SEAL_IN, 1, 15, {
    SEAL_IN[1],
    '+---| |---+---|/|---+----------------------( )-+',
    '|   Y0    |   X2    |                          |',
    '+---| |---+---| |---+                          |',
  } },
  { 'insert-rung', '\\g', PLAIN, 1, 5, join(PLAIN, '', EMPTY) },
  { 'insert-rung-above', '\\G', PLAIN, 1, 5, join(EMPTY, '', PLAIN) },
  { 'move-branch-up', '\\k', SEAL_IN, 3, 5, {
    '|   Y0        X1                           Y0  |', SEAL_IN[2], '|   X0    |                                    |', SEAL_IN[4],
  } },
  { 'move-branch-down', '\\j', SEAL_IN, 1, 5, {
    '|   Y0        X1                           Y0  |', SEAL_IN[2], '|   X0    |                                    |', SEAL_IN[4],
  } },
  { 'wrap-in-branch', 'v10l\\pX2<Esc>', TWO, 1, 4, {
    TWO[1],
    '+---| |-----| |---+------------------------( )-+',
    '|   X2            |                            |',
    '+---| |-----------+                            |',
  } },
  { 'delete-element', '\\d', SEAL_IN, 1, 15, {
    '|   X0                                     Y0  |',
    '+---| |---+--------------------------------( )-+',
    SEAL_IN[3], SEAL_IN[4],
  } },
  { 'delete-branch', '\\D', SEAL_IN, 3, 5, {
    '|   X0      X1                             Y0  |',
    '+---| |-----|/|----------------------------( )-+',
  } },
  { 'negate', '\\i', SEAL_IN, 1, 15, {
    SEAL_IN[1], '+---| |---+---| |--------------------------( )-+', SEAL_IN[3], SEAL_IN[4],
  } },
  { 'mend', '\\m', join('|   X10        X1                           Y0  |', vim.list_slice(SEAL_IN, 2)), 0, 4,
    join('|   X10       X1                           Y0  |', vim.list_slice(SEAL_IN, 2)) },
}

for _, script in ipairs(EDITS) do
  local name, keys, before, line, column, after = unpack(script)
  check('the edit ' .. name .. ' by ' .. keys, function()
    nvim:open('edited.lad', program(before), line, column)
    local typed = keys:match('^(.-\\%a)(.+)<Esc>$')
    if typed then
      -- The name is typed when the placeholder is there and selected.
      local command, operand = keys:match('^(.-\\%a)(.+)<Esc>$')
      nvim:press(command)
      nvim:until_true('the placeholder', function()
        return nvim:request('nvim_get_mode').mode == 's'
      end)
      nvim:type(operand)
      nvim:press('<Esc>')
    else
      nvim:press(keys)
    end
    same('the drawing after ' .. name, program(after))
    if not typed then
      nvim:press('u')
      same('one undo of ' .. name, program(before))
    end
  end)
end

--- Each: keys at the cursor, the drawing afterwards.
local OBJECTS = {
  { 'yir and p copy a rung', 'yirGo<Esc>p', 1, 5, join(SEAL_IN, END, SEAL_IN) },
  { 'dar deletes a rung', 'dar', 1, 5, { '+--[END]---------------------------------------+' } },
}

for _, script in ipairs(OBJECTS) do
  local name, keys, line, column, after = unpack(script)
  check(name, function()
    nvim:open('objects.lad', program(SEAL_IN), line, column)
    nvim:press(keys)
    nvim:settle()
    same(name, table.concat(after, '\n'))
  end)
end

nvim:stop()
finish()
