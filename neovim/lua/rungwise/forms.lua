--- The forms of the rung at the cursor, ladder, instruction lists and boolean, in a window beside that follows the cursor.
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

local COMMAND = 'rungwise.translate'
local NAME = 'rungwise://forms'
--- The cursor is not followed at each step, but soon enough to be felt as at once.
local FOLLOW_MS = 100
local FENCES = { ladder = 'ladder', fx = 'il', iec = 'il' }

--- The page's buffer, the timer that runs, and the question that is not answered yet.
local page, timer, asking

local function title(form)
  local titles = {
    ladder = t('Ladder diagram'), fx = t('Instruction list, FX'), iec = t('Instruction list, IEC 61131-3'),
    boolean = t('Boolean form'),
  }
  local certificates = {
    proved = t('proved equal'), construction = t('equal by construction'), undecided = t('not decided'),
  }
  local certificate = certificates[form.certificate]
  return (titles[form.to] or tostring(form.to)) .. (certificate and ' — ' .. certificate or '')
end

--- The answer of the server as lines of Markdown, with the forms as programs in fences.
local function lines_of(answer)
  local lines = {}
  for _, form in ipairs(type(answer) == 'table' and type(answer.forms) == 'table' and answer.forms or {}) do
    local text = tostring(form.text):gsub('\n+$', '')
    -- A fence is longer than any row of backticks in the program.
    local longest = 2
    for row in text:gmatch('`+') do
      longest = math.max(longest, #row)
    end
    local fence = ('`'):rep(longest + 1)
    vim.list_extend(lines, { '## ' .. title(form), '', fence .. (FENCES[form.to] or '') })
    vim.list_extend(lines, vim.split(text, '\n'))
    vim.list_extend(lines, { fence, '' })
    local notes = type(form.notes) == 'table' and form.notes or {}
    for _, note in ipairs(notes) do
      -- A line of a buffer has no end in it.
      table.insert(lines, '- ' .. tostring(note):gsub('\n', ' '))
    end
    if #notes > 0 then
      table.insert(lines, '')
    end
  end
  return #lines > 0 and lines or { t('There is no rung at the cursor.') }
end

local function is_shown()
  return page and vim.api.nvim_buf_is_valid(page) and vim.fn.bufwinid(page) ~= -1
end

local function put(lines)
  if is_shown() and not vim.deep_equal(lines, vim.api.nvim_buf_get_lines(page, 0, -1, false)) then
    vim.bo[page].modifiable = true
    vim.api.nvim_buf_set_lines(page, 0, -1, false, lines)
    vim.bo[page].modifiable = false
  end
end

--- The client of a buffer that translates; nil if its server does not.
local function translator(buffer)
  local running = client.clients(buffer)[1]
  local provider = running and running.server_capabilities.executeCommandProvider
  return provider and vim.list_contains(provider.commands or {}, COMMAND) and running or nil
end

--- The selected lines in Visual mode, else the place of the cursor, as the server takes them.
local function place(encoding)
  local found = { uri = vim.uri_from_bufnr(0), to = 'all' }
  if vim.fn.mode():match('^[vV\22]') then
    local first, last = vim.fn.line('v'), vim.fn.line('.')
    found.range = {
      start = { line = math.min(first, last) - 1, character = 0 },
      ['end'] = { line = math.max(first, last), character = 0 },
    }
  else
    found.position = vim.lsp.util.make_position_params(0, encoding).position
  end
  return found
end

local function cancel()
  if asking then
    client.cancel(asking.client, asking.id)
    asking = nil
  end
end

local function follow()
  local buffer = vim.api.nvim_get_current_buf()
  local running = translator(buffer)
  cancel()
  if not running or not is_shown() then
    return
  end
  local own = { client = running }
  asking = own
  local params = { command = COMMAND, arguments = { place(running.offset_encoding) } }
  own.id = client.request(running, 'workspace/executeCommand', params, function(err, result)
    -- The answer to a question of before would show another rung.
    if asking == own then
      asking = nil
      put(err and { err.message or vim.inspect(err) } or lines_of(result))
    end
  end, buffer)
end

--- Follows soon; a cursor that runs on is followed on its way.
local function moved()
  if not timer and vim.list_contains({ 'ladder', 'plc-il' }, vim.bo.filetype) then
    timer = vim.defer_fn(function()
      timer = nil
      follow()
    end, FOLLOW_MS)
  end
end

local function make_page()
  page = vim.api.nvim_create_buf(false, true)
  vim.api.nvim_buf_set_name(page, NAME)
  vim.bo[page].bufhidden = 'wipe'
  -- While there is no program in it yet, no server is started for it.
  vim.bo[page].filetype = 'markdown'
  vim.bo[page].modifiable = false
  vim.keymap.set('n', 'q', '<Cmd>close<CR>', { buffer = page, desc = t('Close the page') })
  local group = vim.api.nvim_create_augroup('rungwise_forms', { clear = true })
  local events = { 'CursorMoved', 'CursorMovedI', 'TextChanged', 'TextChangedI', 'ModeChanged', 'BufEnter' }
  vim.api.nvim_create_autocmd(events, { group = group, callback = moved })
  vim.api.nvim_create_autocmd('BufWipeout', {
    group = group,
    buffer = page,
    callback = function()
      page = nil
      cancel()
      vim.api.nvim_del_augroup_by_id(group)
    end,
  })
end

--- Opens the window; does nothing where the server does not translate.
function M.open()
  if not translator(vim.api.nvim_get_current_buf()) then
    return
  end
  if not is_shown() then
    local program = vim.api.nvim_get_current_win()
    if not page or not vim.api.nvim_buf_is_valid(page) then
      make_page()
    end
    vim.cmd('rightbelow vsplit')
    vim.api.nvim_win_set_buf(0, page)
    vim.wo.wrap = false
    vim.api.nvim_set_current_win(program)
  end
  follow()
end

return M
